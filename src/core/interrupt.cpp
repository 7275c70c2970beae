#include <tautline/core/interrupt.hpp>

#include <csignal>
#include <cstdlib>
#include <cstring>

#include <sys/time.h>
#include <unistd.h>

namespace tautline {

namespace {

constexpr int interrupted = 130;  // ExitCode::interrupted
constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t requested = 0;
itimerval patience{};

void say(const char* text) {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
}

void end_at_once(int) {
  std::_Exit(interrupted);
}

void on_signal(int) {
  if (requested != 0) std::_Exit(interrupted);
  requested = 1;
  setitimer(ITIMER_REAL, &patience, nullptr);
}

/// The work in hand is one long piece, e.g. the factors of a large matrix. Files are written beside their
/// names and renamed, so that they are whole at any time.
void on_alarm(int) {
  say("\nstopped within a long piece of work, without the tables of the last state; results.json and the "
      "checkpoints are whole\n");
  std::_Exit(interrupted);
}

/// A hang-up that is ignored from the start (nohup) stays so.
void handle_all(void (*handler)(int)) {
  for (const int signal : signals)
    if (std::signal(signal, handler) == SIG_IGN && signal == SIGHUP) std::signal(signal, SIG_IGN);
}

}  // namespace

void watch_for_interrupt(double seconds) {
  patience.it_value.tv_sec = static_cast<time_t>(seconds);
  patience.it_value.tv_usec =
      static_cast<suseconds_t>(1e6 * (seconds - static_cast<double>(patience.it_value.tv_sec)));
  std::signal(SIGALRM, on_alarm);
  handle_all(on_signal);
}

void end_at_interrupt() {
  handle_all(end_at_once);
}

bool interrupt_requested() noexcept {
  return requested != 0;
}

}  // namespace tautline
