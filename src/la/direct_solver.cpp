#include <tautline/la/direct_solver.hpp>

#include <chrono>

#include <fmt/format.h>
#include <petscksp.h>

#include <tautline/core/interrupt.hpp>
#include <tautline/core/out_of_memory.hpp>
#include <tautline/la/session.hpp>

#include "la/check.hpp"

namespace tautline::la {

namespace {

constexpr int usual_work_space = 60;  // on top of what MUMPS foresees [%]

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

bool is_singular(int code) {
  return code == -6 || code == -10;
}

/// Whether MUMPS asks for more work space than it foresaw.
bool wants_more(int code) {
  return code == -8 || code == -9 || code == -14 || code == -15 || code == -17 || code == -20;
}

bool lacks_memory(int code) {
  return code == -5 || code == -7 || code == -13 || code == -19 || code == -22 || code == -37;
}

std::string explain_mumps(int code, int detail) {
  if (is_singular(code))
    return fmt::format("the matrix is singular (MUMPS INFOG(1) = {}, pivots found {})", code, detail);
  return fmt::format(
      "MUMPS failed with INFOG(1) = {}, INFOG(2) = {}; see its users' guide, section on error diagnostics",
      code, detail);
}

[[noreturn]] void refuse_mumps(int code, int detail) {
  if (lacks_memory(code)) throw OutOfMemory(fmt::format("MUMPS, INFOG(1) = {}, {}", code, detail));
  if (wants_more(code))
    throw OutOfMemory(fmt::format(
        "MUMPS, whose work space was too small even after several enlargements, INFOG(1) = {}, {}", code,
        detail));
  throw LibraryError(explain_mumps(code, detail));
}

/// Where the work space that MUMPS foresaw is too small it gets more; where there is no memory for it, once
/// less. @return INFOG(1)
int factor_with_room(_p_KSP* ksp, const SymmetricMatrix& matrix) {
  constexpr int most = 2000, little = 10;  // part of what MUMPS foresees, on top of it [%]
  bool spared = false;
  for (int part = usual_work_space;;) {
    check(KSPSetUp(ksp), "KSPSetUp");
    const int code = infog(ksp, 1);
    if (wants_more(code) && part <= most && !spared) {
      part *= 2;
    } else if (lacks_memory(code) && !spared) {
      part = little;
      spared = true;
    } else {
      return code;
    }
    check(MatMumpsSetIcntl(factors_of(ksp), 14, part), "MatMumpsSetIcntl");
    touch(matrix.handle());
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
  check(MatMumpsSetIcntl(factors, 14, usual_work_space), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 24, 1), "MatMumpsSetIcntl");
  check(MatMumpsSetIcntl(factors, 28, 1), "MatMumpsSetIcntl");
  check(MatMumpsSetCntl(factors, 3, 1e-14), "MatMumpsSetCntl");
  options_set_ = true;
}

bool DirectSolver::factor(const SymmetricMatrix& matrix) {
  if (true_on_any_rank(interrupt_requested())) throw Interrupted();
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
  const int code = factor_with_room(ksp_, matrix);
  timings_.factorisation += seconds_since(start);
  ++timings_.factorisations;
  if (code >= 0) return true;
  if (!is_singular(code)) refuse_mumps(code, infog(ksp_, 2));
  failure_ = explain_mumps(code, infog(ksp_, 2));
  return false;
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
