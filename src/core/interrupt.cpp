#include <tautline/core/interrupt.hpp>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include <unistd.h>

namespace tautline {

namespace {

constexpr unsigned patience = 10;  // [s] until a process that does not look at the flag is ended

volatile std::sig_atomic_t requested = 0, seen = 0, waited = 0;

void say(const char* text) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

void on_signal(int signal) {
  if (requested != 0) std::_Exit(128 + signal);
  requested = 1;
  alarm(1);
}

/// The work in hand is one long piece, e.g. the factors of a large matrix. results.json and the checkpoints
/// on the disk are whole at any time.
void on_alarm(int) {
  if (seen != 0) return;
  if (waited != 0) {
    say("\nstopped without the tables of the last state; results.json and the checkpoints are whole\n");
    std::_Exit(130);
  }
  waited = 1;
  say("\nstopping as soon as the piece of work in hand is done; once more: at once\n");
  alarm(patience - 1);
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGALRM, on_alarm);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

void end_at_interrupt() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool interrupt_requested() noexcept {
  if (requested != 0) seen = 1;
  return requested != 0;
}

}  // namespace tautline
