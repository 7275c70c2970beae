#pragma once
/// @file
/// Progress of long work on stderr: one live line on a terminal, plain lines in a file, nothing when quiet.

#include <chrono>
#include <string>

namespace tautline {

/// Writes progress. Only rank 0 should be given an enabled instance.
class Progress {
 public:
  enum class Mode { silent, lines, live };

  /// @return live if stderr is a terminal, else lines.
  static Mode detect();

  explicit Progress(Mode mode = Mode::silent) : mode_(mode) {}
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { finish(); }

  /// A message worth keeping (a step begins or ends).
  void say(const std::string& text);
  /// The state of work in hand. Live: overwrites the line. Lines: at most one every five seconds.
  void update(const std::string& text);
  /// Clears the live line.
  void finish();

 private:
  Mode mode_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace tautline
