#include <tautline/la/eigen_solver.hpp>

#include <fmt/format.h>
#include <slepceps.h>

#include <tautline/core/error.hpp>

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

void configure(::EPS eps, const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count, double shift) {
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
  // A start vector of ones makes runs repeatable for any number of ranks.
  ::Vec start = nullptr;
  check(MatCreateVecs(stiffness.handle(), &start, nullptr), "MatCreateVecs");
  check(VecSet(start, 1.0), "VecSet");
  check(EPSSetInitialSpace(eps, 1, &start), "EPSSetInitialSpace");
  check(VecDestroy(&start), "VecDestroy");
}

double residual(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double value, const Vector& x) {
  ::Vec kx = nullptr, r = nullptr;
  check(VecDuplicate(x.handle(), &kx), "VecDuplicate");
  check(VecDuplicate(x.handle(), &r), "VecDuplicate");
  check(MatMult(stiffness.handle(), x.handle(), kx), "MatMult");
  check(MatMult(mass.handle(), x.handle(), r), "MatMult");
  check(VecAYPX(r, -value, kx), "VecAYPX");
  const double result = Vector(r).norm() / Vector(kx).norm();
  check(VecDestroy(&kx), "VecDestroy");
  check(VecDestroy(&r), "VecDestroy");
  return result;
}

}  // namespace

EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count, double shift) {
  const Handle eps;
  configure(eps.get(), stiffness, mass, count, shift);
  check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  if (converged < count)
    throw LibraryError(fmt::format("SLEPc found {} of the {} modes asked for: ask for fewer, or check that the structure has mass",
                                   static_cast<int>(converged), count));
  EigenPairs pairs;
  for (int i = 0; i < count; ++i) {
    ::Vec x = nullptr;
    check(MatCreateVecs(stiffness.handle(), &x, nullptr), "MatCreateVecs");
    PetscScalar value = 0;
    check(EPSGetEigenpair(eps.get(), i, &value, nullptr, x, nullptr), "EPSGetEigenpair");
    pairs.values.push_back(value);
    pairs.vectors.push_back(Vector::adopt(x));
    pairs.residuals.push_back(residual(stiffness, mass, value, pairs.vectors.back()));
  }
  return pairs;
}

}  // namespace tautline::la
