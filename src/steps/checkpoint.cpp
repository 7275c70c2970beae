#include "steps/checkpoint.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/results.hpp>

#include "steps/checkpoint_file.hpp"

namespace tautline::steps {

namespace {

namespace fs = std::filesystem;

constexpr const char* point_file = "point.bin";

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The checkpoint with the fingerprints of what it stands on and of the steps that it holds something of.
CheckpointFile file_of(const Checkpoint& checkpoint, const deck::Deck& deck) {
  const long fixed = checkpoint.steps_done + (checkpoint.point ? 1 : 0);
  const auto& all = deck.step_fingerprints;
  return {deck.fingerprint, {all.begin(), all.begin() + fixed}, checkpoint};
}

/// Nothing of a file that is not what a run wrote is used.
[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw LibraryError(fmt::format(
      "the checkpoint {} {}: run without --from, or take that file away to go on from the others beside it",
      path.string(), why));
}

CheckpointFile read(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) refuse(path, "is no file");
  try {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad() || bytes.size() != fs::file_size(path, error))
      refuse(path, "cannot be read");
    return decode(bytes);
  } catch (const BadCheckpoint& bad) {
    refuse(path, bad.what());
  } catch (const std::bad_alloc&) {
    refuse(path, "is larger than the memory");
  }
}

std::vector<std::size_t> sizes_of(const model::State& state) {
  std::vector<std::size_t> sizes;
  each_list_of_state(state, [&](const auto& list) { sizes.push_back(list.size()); });
  return sizes;
}

/// Of every list.
std::vector<std::size_t> sizes_of(const assembly::Rest& rest) {
  std::vector<std::size_t> sizes;
  each_list(rest, [&](const auto& list) { sizes.push_back(list.size()); });
  return sizes;
}

/// Whether the first steps of the deck are those of the checkpoint.
bool fits(const CheckpointFile& file, const deck::Deck& deck) {
  return file.steps.size() <= deck.step_fingerprints.size() &&
         std::equal(file.steps.begin(), file.steps.end(), deck.step_fingerprints.begin());
}

std::string step_file(int steps_done) {
  return fmt::format("step_{}.bin", steps_done);
}

}  // namespace

Checkpoints::Checkpoints(const deck::Deck& deck, std::string directory)
    : deck_(deck), directory_(std::move(directory)) {}

void Checkpoints::write(const Checkpoint& checkpoint, const std::string& name) {
  const Stopwatch watch(seconds_);
  la::on_root([&] {
    fs::create_directories(directory_);
    output::write_durably(directory_ + "/" + name, encode(file_of(checkpoint, deck_)));
  });
}

void Checkpoints::save(const Checkpoint& checkpoint) {
  write(checkpoint, step_file(checkpoint.steps_done));
  la::on_root([&] { fs::remove(fs::path(directory_) / point_file); });
  latest_ = checkpoint;
  next_ = 0;
}

void Checkpoints::begin_at(const Checkpoint& checkpoint) {
  latest_ = checkpoint;
  latest_.point.reset();
}

void Checkpoints::save_point(const Checkpoint& checkpoint, bool always) {
  const double start = now_seconds();
  if (!la::true_on_any_rank(always || start >= next_)) return;
  write(checkpoint, point_file);
  const double seconds = now_seconds() - start;
  next_ = start + 20 * seconds;
}

void require_fit(const Checkpoint& checkpoint, const assembly::Rest& wanted, const std::string& from) {
  const auto sizes = sizes_of(wanted);
  const auto& point = checkpoint.point;
  if ((!checkpoint.rest || sizes_of(*checkpoint.rest) == sizes) &&
      (!point || (sizes_of(point->start) == sizes && sizes_of(point->place.state) == sizes_of(wanted.state))))
    return;
  throw LibraryError(
      fmt::format("the checkpoints in {} hold a state of another mesh than the one that form-finding and "
                  "meshing have made now: run without --from",
                  from));
}

std::optional<Checkpoint> find_checkpoint(const deck::Deck& deck, const std::string& directory) {
  const fs::path folder = fs::path(directory) / "checkpoints";
  if (!fs::is_directory(folder))
    throw LibraryError(
        fmt::format("there are no checkpoints in {}: --from wants the directory of results of an "
                    "earlier run",
                    directory));
  std::vector<std::string> names{point_file};
  for (int k = static_cast<int>(deck.steps.size()); k > 0; --k) names.push_back(step_file(k));
  std::optional<Checkpoint> best;
  for (const auto& name : names) {
    if (!fs::exists(folder / name)) continue;
    auto file = read(folder / name);
    if (file.structure != deck.fingerprint)
      refuse(folder / name, fmt::format("belongs to another structure than {} (or its mesh file has changed; "
                                        "only steps, title, solver and output may differ)",
                                        deck.path));
    if (!fits(file, deck)) continue;
    const auto& checkpoint = file.checkpoint;
    if (checkpoint.point && !std::holds_alternative<EquilibriumOptions>(
                                deck.steps[static_cast<std::size_t>(checkpoint.steps_done)].options))
      refuse(folder / name, "holds a point of a step that has no path");
    if (!best || checkpoint.steps_done > best->steps_done) best = std::move(file.checkpoint);
  }
  return best;
}

}  // namespace tautline::steps
