#include <tautline/core/progress.hpp>

#include <cstdio>

#include <unistd.h>

namespace tautline {

Progress::Mode Progress::detect() {
  return isatty(STDERR_FILENO) != 0 ? Mode::live : Mode::lines;
}

void Progress::say(const std::string& text) {
  if (mode_ == Mode::silent) return;
  finish();
  std::fprintf(stderr, "%s\n", text.c_str());
}

void Progress::update(const std::string& text) {
  if (mode_ == Mode::silent) return;
  const auto now = std::chrono::steady_clock::now();
  const auto pause = mode_ == Mode::live ? std::chrono::milliseconds(80) : std::chrono::milliseconds(5000);
  if (now - last_ < pause) return;
  last_ = now;
  if (mode_ == Mode::live) {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    line_open_ = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void Progress::finish() {
  if (!line_open_) return;
  std::fprintf(stderr, "\r\033[K");
  line_open_ = false;
}

}  // namespace tautline
