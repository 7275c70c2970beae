#include <tautline/core/interrupt.hpp>

#include <csignal>
#include <cstdlib>

namespace tautline {

namespace {

volatile std::sig_atomic_t requested = 0;

void on_signal(int signal) {
  if (requested != 0) std::_Exit(128 + signal);
  requested = 1;
}

}  // namespace

void watch_for_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupt_requested() noexcept {
  return requested != 0;
}

}  // namespace tautline
