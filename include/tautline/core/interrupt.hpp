#pragma once
/// @file
/// Ctrl-C as a flag that long work looks at between iterations.

namespace tautline {

/// From now on SIGINT and SIGTERM only set the flag; a second SIGINT ends the process at once.
void watch_for_interrupt();

/// Whether the user asked to stop.
bool interrupt_requested() noexcept;

}  // namespace tautline
