#pragma once
/// @file
/// Start and end of MPI, PETSc and SLEPc, and the few collective operations the program needs.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tautline::la {

/// Whether PETSc and SLEPc may read options from files (.petscrc) and from PETSC_OPTIONS: only where
/// TAUTLINE_PETSC_OPTIONS=1 is in the environment.
bool takes_petsc_options();

/// Lives as long as anything of la is used; made once, in main.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// Whether a session has begun.
bool started();
/// Whether mpirun started this process among others; can be asked before a session begins.
bool launched_by_mpirun();

/// This process among those of the run; 0 if no session has begun.
int rank();
int size();

double sum_over_ranks(double value);
double max_over_ranks(double value);
/// Whether it is true anywhere: how ranks agree before they throw. Collective.
bool true_on_any_rank(bool value);
/// Does `action` on rank 0 only; if it throws there, every rank throws a LibraryError with the same text.
/// Collective.
void on_root(const std::function<void()>& action);
/// Ends all ranks at once with an exit code: the last resort when one rank alone has failed.
[[noreturn]] void abort_all_ranks(int exit_code);
/// Adds `values` (equal length everywhere) over all ranks; the result is everywhere.
void sum_over_ranks(std::vector<double>& values);

struct LibraryVersions {
  std::string petsc, slepc, mumps;
};
LibraryVersions library_versions();

/// Largest memory this process has held, summed over ranks [bytes]. Collective.
std::size_t peak_memory_bytes();

}  // namespace tautline::la
