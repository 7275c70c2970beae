#pragma once
/// @file
/// PETSc's error codes as LibraryError.

#include <petscsys.h>

namespace tautline::la {

/// @throws LibraryError with the function, PETSc's code and text if `code` is an error
void check(PetscErrorCode code, const char* what);

}  // namespace tautline::la
