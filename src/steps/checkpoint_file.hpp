#pragma once
/// @file
/// What a checkpoint is as bytes: sealed by a checksum, numbers raw, nothing believed when it is read.
///
///     tautline-checkpoint 4\n
///     SHA-256 of all that follows, 64 hexadecimal digits, \n
///     n                                          length of the text [8 bytes]
///     text                                       JSON, n bytes: names, results, what is not a list of
///     numbers count, count x double                      each list: number of doubles [8 bytes], the doubles
///
/// Integers and doubles (IEEE 754) are little-endian on any machine. Lists of vectors and matrices are their
/// entries one after the other, matrices by columns. Which lists there are, in which order: `each_list`.

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "steps/checkpoint.hpp"

namespace tautline::steps {

/// A checkpoint and what it belongs to.
struct CheckpointFile {
  std::string structure;           ///< fingerprint of what steps stand on
  std::vector<std::string> steps;  ///< fingerprints of the steps done, and of the one begun
  Checkpoint checkpoint;
};

/// Bytes that are no checkpoint of this version; `what` continues "the checkpoint FILE".
struct BadCheckpoint : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string encode(const CheckpointFile& file);

/// @throws BadCheckpoint unless every size, type and number is one that a run writes
CheckpointFile decode(std::string_view bytes);

/// Head and checksum before `content`: for tests, which write contents that no run does.
std::string sealed(std::string_view content);

/// Calls `list` with every list of numbers of a state: the order in files.
template <class State, class List>
void each_list_of_state(State& state, const List& list) {
  list(state.displacement);
  list(state.rotation);
  list(state.hinge_angle);
  list(state.turn);
}

/// Likewise of a system at rest.
template <class Rest, class List>
void each_list(Rest& rest, const List& list) {
  each_list_of_state(rest.state, list);
  auto& acting = rest.acting;
  list(acting.force);
  list(acting.moment);
  list(acting.line);
  list(acting.pressure);
  list(acting.temperature);
  list(acting.temperature_gradient);
  list(acting.strain);
  list(rest.stiffness_factor);
}

}  // namespace tautline::steps
