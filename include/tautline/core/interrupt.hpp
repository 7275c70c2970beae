#pragma once
/// @file
/// Ctrl-C as a flag that long work looks at between iterations.

namespace tautline {

/// From now on SIGINT, SIGTERM and SIGHUP (unless nohup has it ignored) only set the flag. A process that has
/// not come to its end `patience` seconds later is ended, as by a second signal at once: exit code 130.
void watch_for_interrupt(double patience = 1.2);

/// These signals end the process at once, as where nothing is to be saved: exit code 130.
void end_at_interrupt();

/// Whether the user asked to stop.
bool interrupt_requested() noexcept;

}  // namespace tautline
