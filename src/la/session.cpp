#include <tautline/la/session.hpp>

#include <cstdlib>
#include <string_view>

#include <dmumps_c.h>
#include <fmt/format.h>
#include <slepcsys.h>
#include <sys/resource.h>

#include <tautline/core/out_of_memory.hpp>

#include "la/check.hpp"
#include "la/room.hpp"

namespace tautline::la {

namespace {

/// PETSc's allocator reports its line in place of PETSC_ERR_MEM; MUMPS's solve phase tells its INFOG(1).
bool lacks_memory(PetscErrorCode code, std::string_view text) {
  if (code == PETSC_ERR_MEM || code > PETSC_ERR_MAX_VALUE) return true;
  for (const char* told : {"INFOG(1)=-13", "INFOG(1)=-7,", "INFOG(1)=-5,", "INFOG(1)=-19", "INFO(1)=-13"})
    if (text.find(told) != std::string_view::npos) return true;
  return false;
}

}  // namespace

void check(PetscErrorCode code, const char* what) {
  if (code == 0) return;
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  if (lacks_memory(code, specific != nullptr ? specific : ""))
    throw OutOfMemory(fmt::format("PETSc, {}", what));
  throw LibraryError(fmt::format("PETSc failed in {} with code {}: {} {}", what, static_cast<int>(code),
                                 text != nullptr ? text : "", specific != nullptr ? specific : ""));
}

namespace {

/// Keeps PETSc from printing its own traceback: errors reach the user through LibraryError.
PetscErrorCode quiet(MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType,
                     const char*, void*) {
  return code;
}

}  // namespace

bool takes_petsc_options() {
  const char* asked = std::getenv("TAUTLINE_PETSC_OPTIONS");
  return asked != nullptr && std::string_view(asked) == "1";
}

Session::Session() {
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);  // without mpirun no daemon: a third of a second a run
  char program[] = "tautline", skip[] = "-skip_petscrc";  // obeyed as an argument only
  char* list[] = {program, skip, nullptr};
  char** arguments = list;
  int n_arguments = 1;
  if (!takes_petsc_options()) {  // options can load libraries and change results
    for (const char* name : {"PETSC_OPTIONS", "PETSC_OPTIONS_YAML"}) unsetenv(name);
    n_arguments = 2;
  }
  demand_room(60);
  PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);
  check(SlepcInitialize(&n_arguments, &arguments, nullptr, nullptr), "SlepcInitialize");
  check(PetscPushErrorHandler(quiet, nullptr), "PetscPushErrorHandler");
  hold_blas_buffer();
}

Session::~Session() {
  SlepcFinalize();
}

bool started() {
  int value = 0;
  MPI_Initialized(&value);
  return value != 0;
}

bool launched_by_mpirun() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

int rank() {
  int value = 0;
  if (!started()) return 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &value);
  return value;
}

int size() {
  int value = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &value);
  return value;
}

double sum_over_ranks(double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return value;
}

double max_over_ranks(double value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return value;
}

bool true_on_any_rank(bool value) {
  return max_over_ranks(value ? 1.0 : 0.0) > 0;
}

void on_root(const std::function<void()>& action) {
  std::string failure;
  int head[] = {0, 0};  // length of the failure's text, and whether it is for want of memory
  if (rank() == 0) {
    try {
      action();
    } catch (const std::exception& error) {
      failure = error.what();
      if (failure.empty()) failure = "unknown failure";
      head[1] = is_out_of_memory(error) ? 1 : 0;
    }
    head[0] = static_cast<int>(failure.size());
  }
  MPI_Bcast(head, 2, MPI_INT, 0, PETSC_COMM_WORLD);
  const auto [length, for_memory] = head;
  if (length == 0) return;
  if (for_memory != 0) throw OutOfMemory();
  failure.resize(static_cast<std::size_t>(length));
  MPI_Bcast(failure.data(), length, MPI_CHAR, 0, PETSC_COMM_WORLD);
  throw LibraryError(failure);
}

void abort_all_ranks(int exit_code) {
  MPI_Abort(PETSC_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

void sum_over_ranks(std::vector<double>& values) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
}

LibraryVersions library_versions() {
  return {fmt::format("{}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR),
          fmt::format("{}.{}.{}", SLEPC_VERSION_MAJOR, SLEPC_VERSION_MINOR, SLEPC_VERSION_SUBMINOR),
          MUMPS_VERSION};
}

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(sum_over_ranks(static_cast<double>(usage.ru_maxrss) * 1024.0));
}

}  // namespace tautline::la
