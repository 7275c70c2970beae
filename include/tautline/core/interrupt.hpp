#pragma once
/// @file
/// Ctrl-C as a flag that long work looks at between iterations.

namespace tautline {

/// From now on SIGINT and SIGTERM only set the flag. Work that does not look at it within a second is told
/// of, after ten seconds the process ends; a second signal ends it at once.
void watch_for_interrupt();

/// SIGINT and SIGTERM end the process, as where nothing is to be saved.
void end_at_interrupt();

/// Whether the user asked to stop.
bool interrupt_requested() noexcept;

}  // namespace tautline
