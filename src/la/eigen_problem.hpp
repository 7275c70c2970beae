#pragma once
/// @file
/// A symmetric eigenproblem of SLEPc's, solved with MUMPS.

#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <tautline/la/symmetric_matrix.hpp>

#include "la/check.hpp"

namespace tautline::la {

/// Owns an eigenproblem.
class EigenHandle {
 public:
  EigenHandle() { check(EPSCreate(PETSC_COMM_WORLD, &eps_), "EPSCreate"); }
  ~EigenHandle() { EPSDestroy(&eps_); }
  EigenHandle(const EigenHandle&) = delete;
  EigenHandle& operator=(const EigenHandle&) = delete;
  ::EPS get() const { return eps_; }

 private:
  ::EPS eps_ = nullptr;
};

/// A start vector that shares no symmetry of any structure (one that does never meets the modes that do not),
/// the same in every run.
inline void set_start(::EPS eps, const SymmetricMatrix& stiffness) {
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

/// A x = nu B x, `count` pairs, by Krylov-Schur with MUMPS for what is to be inverted.
inline void set_problem(::EPS eps, const SymmetricMatrix& a, const SymmetricMatrix& b, int count) {
  check(EPSSetOperators(eps, a.handle(), b.handle()), "EPSSetOperators");
  check(EPSSetProblemType(eps, EPS_GHEP), "EPSSetProblemType");
  PetscInt size = 0;
  check(MatGetSize(a.handle(), &size, nullptr), "MatGetSize");
  check(EPSSetDimensions(eps, std::min<PetscInt>(count, size), PETSC_DEFAULT, PETSC_DEFAULT),
        "EPSSetDimensions");
  check(EPSSetTolerances(eps, 1e-12, 500), "EPSSetTolerances");
  ::ST transform = nullptr;
  ::KSP ksp = nullptr;
  ::PC pc = nullptr;
  check(EPSGetST(eps, &transform), "EPSGetST");
  check(STSetMatStructure(transform, SUBSET_NONZERO_PATTERN), "STSetMatStructure");
  check(STGetKSP(transform, &ksp), "STGetKSP");
  check(KSPSetType(ksp, KSPPREONLY), "KSPSetType");
  check(KSPGetPC(ksp, &pc), "KSPGetPC");
  check(PCSetType(pc, PCCHOLESKY), "PCSetType");
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS), "PCFactorSetMatSolverType");
  set_start(eps, a);
}

/// A place between two values, and how many are before it.
struct Gap {
  int before = 0;
  double place = 0;
};

/// @brief The first gap behind at least `count` of some values in order, so that what is before it can be
/// counted whatever the last digits of those at the cut.
///
/// Without a gap, a place a little behind the last value.
inline Gap gap_behind(const std::vector<double>& values, int count) {
  constexpr double wide = 1e-5;
  const auto n = static_cast<int>(values.size());
  for (int i = count; i < n; ++i) {
    const double a = values[static_cast<std::size_t>(i - 1)], b = values[static_cast<std::size_t>(i)];
    if (std::abs(b - a) > wide * std::max(std::abs(a), std::abs(b))) return {i, (a + b) / 2};
  }
  const double first = values.front(), last = values.back();
  return {n, last + (last < first ? -wide : wide) * last};
}

}  // namespace tautline::la
