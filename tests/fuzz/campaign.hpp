#pragma once
/// @file
/// What is tried: how a seed becomes an input, what the program does with it, and what it may answer.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <tautline/core/error.hpp>

namespace tautline::fuzz {

/// One input. `text` is what is made smaller when it fails.
struct Input {
  std::string text;    ///< deck, mesh file, overrides (one a line) or results.json
  std::string origin;  ///< file it was made of
};

/// How the program answered.
struct Answer {
  std::string end;    ///< done, bad deck, impossible model, library failed, not converged
  std::string fault;  ///< what is wrong with the answer; "" if nothing
  std::string said;   ///< the message
};

struct Campaign {
  std::string name;
  std::string suffix;  ///< of files that hold an input
  std::function<Input(std::uint64_t seed)> make;
  std::function<Answer(const Input&)> attempt;
};

struct Places {
  std::string source;  ///< the folder of the project
  std::string work;    ///< where files may be written
};

/// decks (check), runs (run, of small decks), meshes (check of decks that read one), overrides (--set),
/// reports.
std::vector<Campaign> campaigns(const Places& places);

/// What is wrong with a refusal: a place outside the text, control characters, no words; "" if nothing.
std::string fault_of(const DeckError& error, const std::string& file, const std::string& text);
std::string fault_of_message(const std::string& message);

}  // namespace tautline::fuzz
