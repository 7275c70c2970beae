#pragma once
/// @file
/// What libraries do not survive the lack of is demanded before they are used.

namespace tautline::la {

/// @throws OutOfMemory unless so much can be had at all, e.g. under `ulimit -v`
void demand_room(int megabytes);

/// Makes OpenBLAS take its buffer of 128 MB now: it does so when it first needs it, and tries for ever if
/// there is none.
/// @throws OutOfMemory
void hold_blas_buffer();

}  // namespace tautline::la
