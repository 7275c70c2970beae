#include <chrono>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tautline/core/error.hpp>
#include <tautline/la/direct_solver.hpp>
#include <tautline/la/eigen_solver.hpp>
#include <utility>

#include "la/check.hpp"

namespace tautline::la {

namespace {

class Handle {
 public:
  Handle() { check(EPSCreate(PETSC_COMM_WORLD, &eps_), "EPSCreate"); }
  ~Handle() { EPSDestroy(&eps_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ::EPS get() const { return eps_; }

 private:
  ::EPS eps_ = nullptr;
};

/// A start vector that shares no symmetry of any structure (one that does never meets the modes that do not),
/// the same in every run.
void set_start(::EPS eps, const SymmetricMatrix& stiffness) {
  ::Vec start = nullptr;
  check(MatCreateVecs(stiffness.handle(), &start, nullptr), "MatCreateVecs");
  PetscInt first = 0, last = 0;
  check(VecGetOwnershipRange(start, &first, &last), "VecGetOwnershipRange");
  for (PetscInt i = first; i < last; ++i)
    check(VecSetValue(start, i, 1 + std::sin(12.9898 * (i + 1)), INSERT_VALUES), "VecSetValue");
  check(VecAssemblyBegin(start), "VecAssemblyBegin");
  check(VecAssemblyEnd(start), "VecAssemblyEnd");
  check(EPSSetInitialSpace(eps, 1, &start), "EPSSetInitialSpace");
  check(VecDestroy(&start), "VecDestroy");
}

void configure(::EPS eps, const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
               double shift) {
  check(EPSSetOperators(eps, stiffness.handle(), mass.handle()), "EPSSetOperators");
  check(EPSSetProblemType(eps, EPS_GHEP), "EPSSetProblemType");
  check(EPSSetTarget(eps, shift), "EPSSetTarget");
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE), "EPSSetWhichEigenpairs");
  check(EPSSetDimensions(eps, count, PETSC_DEFAULT, PETSC_DEFAULT), "EPSSetDimensions");
  check(EPSSetTolerances(eps, 1e-12, 500), "EPSSetTolerances");
  ::ST transform = nullptr;
  ::KSP ksp = nullptr;
  ::PC pc = nullptr;
  check(EPSGetST(eps, &transform), "EPSGetST");
  check(STSetType(transform, STSINVERT), "STSetType");
  check(STSetMatStructure(transform, SUBSET_NONZERO_PATTERN), "STSetMatStructure");
  check(STGetKSP(transform, &ksp), "STGetKSP");
  check(KSPSetType(ksp, KSPPREONLY), "KSPSetType");
  check(KSPGetPC(ksp, &pc), "KSPGetPC");
  check(PCSetType(pc, PCCHOLESKY), "PCSetType");
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "PCFactorSetMatSolverType");
  set_start(eps, stiffness);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

using Clock = std::chrono::steady_clock;

/// Time of the shift-invert solves made inside EPSSolve.
struct SolveClock {
  Clock::time_point start;
  SolverTimings timings;
};

PetscErrorCode before_solve(::KSP, ::Vec, ::Vec, void* data) {
  static_cast<SolveClock*>(data)->start = Clock::now();
  return 0;
}

PetscErrorCode after_solve(::KSP, ::Vec, ::Vec, void* data) {
  auto& clock = *static_cast<SolveClock*>(data);
  clock.timings.solve += seconds_since(clock.start);
  ++clock.timings.solves;
  return 0;
}

::KSP solver_of(::EPS eps) {
  ::ST transform = nullptr;
  ::KSP ksp = nullptr;
  check(EPSGetST(eps, &transform), "EPSGetST");
  check(STGetKSP(transform, &ksp), "STGetKSP");
  return ksp;
}

long double dot(const std::vector<double>& a, const std::vector<long double>& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Sharpens one mode after another; lower modes are kept out of higher ones.
class Refinement {
 public:
  Refinement(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, ::KSP solver)
      : stiffness_(stiffness), mass_(mass), solver_(solver), scale_(stiffness.norm_of_diagonal()) {}

  void refine(Vector& mode, EigenPairs& pairs) {
    std::vector<double> x;
    mode.gather(x);
    long double value = normalise(x);
    for (int round = 0; round < rounds; ++round) {
      correct(mode, x, value);
      value = normalise(x);
    }
    mode.write(own(mode, x));
    pairs.values.push_back(static_cast<double>(value));
    pairs.residuals.push_back(residual(x, value));
    lower_.push_back(x);
    lower_mass_.push_back(mass_.multiply_extended(x));
  }

 private:
  static constexpr int rounds = 2;

  static std::span<const double> own(const Vector& like, const std::vector<double>& all) {
    PetscInt first = 0;
    check(VecGetOwnershipRange(like.handle(), &first, nullptr), "VecGetOwnershipRange");
    return std::span(all).subspan(static_cast<std::size_t>(first),
                                  static_cast<std::size_t>(like.local_size()));
  }

  /// Takes lower modes out, scales to x^T M x = 1 and returns the Rayleigh quotient.
  long double normalise(std::vector<double>& x) const {
    for (std::size_t m = 0; m < lower_.size(); ++m) {
      const auto part = static_cast<double>(dot(x, lower_mass_[m]));
      for (std::size_t i = 0; i < x.size(); ++i) x[i] -= part * lower_[m][i];
    }
    const auto length = static_cast<double>(std::sqrt(dot(x, mass_.multiply_extended(x))));
    for (double& entry : x) entry /= length;
    return dot(x, stiffness_.multiply_extended(x));
  }

  std::vector<double> imbalance(const std::vector<double>& x, long double value) const {
    const auto kx = stiffness_.multiply_extended(x), mx = mass_.multiply_extended(x);
    std::vector<double> r(x.size());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = static_cast<double>(kx[i] - value * mx[i]);
    return r;
  }

  /// x - S^-1 (K x - value M x) with the factored S: one inverse iteration.
  void correct(Vector& mode, std::vector<double>& x, long double value) const {
    const Vector right = Vector::like(mode);
    mode.write(own(mode, imbalance(x, value)));
    check(VecCopy(mode.handle(), right.handle()), "VecCopy");
    check(KSPSolve(solver_, right.handle(), mode.handle()), "KSPSolve");
    std::vector<double> change;
    mode.gather(change);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= change[i];
  }

  double residual(const std::vector<double>& x, long double value) const {
    double r2 = 0, x2 = 0;
    for (const double entry : imbalance(x, value)) r2 += entry * entry;
    for (const double entry : x) x2 += entry * entry;
    return std::sqrt(r2 / x2) / scale_;
  }

  const SymmetricMatrix& stiffness_;
  const SymmetricMatrix& mass_;
  ::KSP solver_;
  double scale_;
  std::vector<std::vector<double>> lower_;
  std::vector<std::vector<long double>> lower_mass_;
};

}  // namespace

EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                           double shift) {
  const Handle eps;
  SolveClock clock;
  configure(eps.get(), stiffness, mass, count, shift);
  const auto start = Clock::now();
  check(EPSSetUp(eps.get()), "EPSSetUp");
  clock.timings.factorisation = seconds_since(start);
  clock.timings.factorisations = 1;
  const ::KSP solver = solver_of(eps.get());
  check(KSPSetPreSolve(solver, before_solve, &clock), "KSPSetPreSolve");
  check(KSPSetPostSolve(solver, after_solve, &clock), "KSPSetPostSolve");
  check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  if (converged < count)
    throw LibraryError(fmt::format(
        "SLEPc found {} of the {} modes asked for: ask for fewer, or check that the structure has mass",
        static_cast<int>(converged), count));
  EigenPairs pairs;
  Refinement refinement(stiffness, mass, solver);
  for (int i = 0; i < count; ++i) {
    ::Vec x = nullptr;
    check(MatCreateVecs(stiffness.handle(), &x, nullptr), "MatCreateVecs");
    pairs.vectors.push_back(Vector::adopt(x));
    check(EPSGetEigenpair(eps.get(), i, nullptr, nullptr, x, nullptr), "EPSGetEigenpair");
    refinement.refine(pairs.vectors.back(), pairs);
  }
  pairs.timings = clock.timings;
  return pairs;
}

}  // namespace tautline::la
