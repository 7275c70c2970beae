#include <tautline/la/direct_solver.hpp>

#include <chrono>

#include <fmt/format.h>
#include <petscksp.h>

#include <tautline/core/error.hpp>

#include "la/check.hpp"

namespace tautline::la {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

::Mat factors_of(_p_KSP* ksp) {
  ::PC pc = nullptr;
  ::Mat factors = nullptr;
  check(KSPGetPC(ksp, &pc), "KSPGetPC");
  check(PCFactorGetMatrix(pc, &factors), "PCFactorGetMatrix");
  return factors;
}

int infog(_p_KSP* ksp, int index) {
  PetscInt value = 0;
  check(MatMumpsGetInfog(factors_of(ksp), index, &value), "MatMumpsGetInfog");
  return value;
}

/// Marks a matrix as changed, so that it is factored again.
void touch(::Mat matrix) {
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
}

std::string explain_mumps(int code, int detail) {
  switch (code) {
    case -5:
    case -7:
    case -13:
    case -19:
      return fmt::format(
          "MUMPS ran out of memory (INFOG(1) = {}, {}): use a machine with more, or more ranks on a cluster",
          code, detail);
    case -6:
    case -10:
      return fmt::format("the matrix is singular (MUMPS INFOG(1) = {}, pivots found {})", code, detail);
    case -8:
    case -9:
      return fmt::format(
          "MUMPS's workspace was too small even after several enlargements (INFOG(1) = {}, {})", code,
          detail);
    default:
      return fmt::format(
          "MUMPS failed with INFOG(1) = {}, INFOG(2) = {}; see its users' guide, section on error "
          "diagnostics",
          code, detail);
  }
}

}  // namespace

DirectSolver::DirectSolver() {
  check(KSPCreate(PETSC_COMM_WORLD, &ksp_), "KSPCreate");
  check(KSPSetType(ksp_, KSPPREONLY), "KSPSetType");
  ::PC pc = nullptr;
  check(KSPGetPC(ksp_, &pc), "KSPGetPC");
  check(PCSetType(pc, PCCHOLESKY), "PCSetType");
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "PCFactorSetMatSolverType");
}

DirectSolver::~DirectSolver() {
  KSPDestroy(&ksp_);
}

/// Inertia wants the whole matrix in the tree (ICNTL(13)) and null pivots seen (ICNTL(24), CNTL(3));
/// approximate minimum fill (ICNTL(7) = 2) suits surface-like meshes.
void DirectSolver::set_options() {
  ::PC pc = nullptr;
  check(KSPGetPC(ksp_, &pc), "KSPGetPC");
  check(PCFactorSetUpMatSolverType(pc), "PCFactorSetUpMatSolverType");
  ::Mat factors = factors_of(ksp_);
  check(MatMumpsSetIcntl(factors, 7, 2), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 13, 1), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 14, 60), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 24, 1), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 28, 1), "MatMumpsSetIcntl");
  check(MatMumpsSetCntl(factors, 3, 1e-14), "MatMumpsSetCntl");
  options_set_ = true;
}

bool DirectSolver::factor(const SymmetricMatrix& matrix) {
  const auto start = std::chrono::steady_clock::now();
  if (options_set_) {  // PETSc makes new factors for another matrix, without the options
    ::Mat last = nullptr;
    check(KSPGetOperators(ksp_, &last, nullptr), "KSPGetOperators");
    if (last != matrix.handle()) {
      check(KSPReset(ksp_), "KSPReset");
      options_set_ = false;
    }
  }
  check(KSPSetOperators(ksp_, matrix.handle(), matrix.handle()), "KSPSetOperators");
  if (!options_set_) set_options();
  failure_.clear();
  int code = 0;
  for (int memory = 120;; memory *= 2) {
    check(KSPSetUp(ksp_), "KSPSetUp");
    code = infog(ksp_, 1);
    if ((code != -8 && code != -9) || memory > 2000) break;
    check(MatMumpsSetIcntl(factors_of(ksp_), 14, memory), "MatMumpsSetIcntl");
    touch(matrix.handle());
  }
  timings_.factorisation += seconds_since(start);
  ++timings_.factorisations;
  if (code >= 0) return true;
  failure_ = explain_mumps(code, infog(ksp_, 2));
  if (code == -6 || code == -10) return false;
  throw LibraryError(failure_);
}

Inertia DirectSolver::inertia() const {
  if (timings_.factorisations == 0) return {};
  PetscInt negative = 0, zero = 0, positive = 0;
  check(MatGetInertia(factors_of(ksp_), &negative, &zero, &positive), "MatGetInertia");
  return {negative, zero};
}

void DirectSolver::solve(const Vector& b, Vector& x) {
  const auto start = std::chrono::steady_clock::now();
  check(KSPSolve(ksp_, b.handle(), x.handle()), "KSPSolve");
  count_solve(seconds_since(start));
}

void DirectSolver::count_solve(double seconds) {
  timings_.solve += seconds;
  ++timings_.solves;
}

void DirectSolver::add(const SolverTimings& elsewhere) {
  timings_.factorisation += elsewhere.factorisation;
  timings_.solve += elsewhere.solve;
  timings_.factorisations += elsewhere.factorisations;
  timings_.solves += elsewhere.solves;
}

MatX DirectSolver::solve_many(const MatX& b) {
  const auto start = std::chrono::steady_clock::now();
  ::Mat right = nullptr, left = nullptr;
  const auto make = [&](double* data, ::Mat* result) {
    check(MatCreateDense(PETSC_COMM_WORLD, static_cast<PetscInt>(b.rows()), PETSC_DECIDE, PETSC_DETERMINE,
                         static_cast<PetscInt>(b.cols()), data, result),
          "MatCreateDense");
    check(MatAssemblyBegin(*result, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
    check(MatAssemblyEnd(*result, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  };
  MatX copy = b;
  MatX x = MatX::Zero(b.rows(), b.cols());
  make(copy.data(), &right);
  make(x.data(), &left);
  check(MatMatSolve(factors_of(ksp_), right, left), "MatMatSolve");
  check(MatDestroy(&right), "MatDestroy");
  check(MatDestroy(&left), "MatDestroy");
  count_solve(seconds_since(start));
  return x;
}

}  // namespace tautline::la
