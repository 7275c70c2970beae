#include <tautline/la/snes.hpp>

#include <chrono>
#include <cmath>
#include <exception>

#include <petscsnes.h>

#include "la/check.hpp"

namespace tautline::la {

namespace {

constexpr PetscErrorCode callback_threw = PETSC_ERR_USER;

/// What the C callbacks need; an exception is kept here and thrown again outside PETSc.
struct Context {
  const SnesCallbacks& callbacks;
  SymmetricMatrix& tangent;
  DirectSolver& solver;
  std::exception_ptr error;
  bool singular = false;
  double stiffening = 0;  ///< added to the diagonal of the tangent at hand
  std::chrono::steady_clock::time_point solve_start{};

  template <class Action>
  PetscErrorCode guard(const Action& action) {
    try {
      action();
      return 0;
    } catch (...) {
      error = std::current_exception();
      return callback_threw;
    }
  }
};

/// A tangent without resistance in a direction that is loaded (a flat film under pressure, the gap between
/// one cable that slackens and another not yet taut) is stiffened in all directions; the line search then
/// finds where the energy stops falling. @return whether there are factors now
bool stiffen(Context& context) {
  constexpr double part = 1e-3;  // of the mean stiffness: a step some times too long along the free direction
  PetscInt n = 0;
  check(MatGetSize(context.tangent.handle(), &n, nullptr), "MatGetSize");
  const double mean = context.tangent.norm_of_diagonal() / std::sqrt(static_cast<double>(n));
  context.stiffening = part * mean;
  context.tangent.shift(context.stiffening);
  return context.solver.factor(context.tangent);
}

PetscErrorCode form_residual(::SNES, ::Vec x, ::Vec f, void* data) {
  auto& context = *static_cast<Context*>(data);
  return context.guard([&] {
    Vector residual(f);
    context.callbacks.residual(Vector(x), residual);
  });
}

PetscErrorCode form_tangent(::SNES snes, ::Vec, ::Mat, ::Mat, void* data) {
  auto& context = *static_cast<Context*>(data);
  return context.guard([&] {
    context.stiffening = 0;
    if (context.callbacks.tangent(context.tangent)) return;
    if (context.solver.factor(context.tangent) || stiffen(context)) return;
    context.singular = true;
    check(SNESSetConvergedReason(snes, SNES_DIVERGED_LINEAR_SOLVE), "SNESSetConvergedReason");
    check(SNESSetJacobianDomainError(snes), "SNESSetJacobianDomainError");
  });
}

PetscErrorCode start_iteration(::SNES snes, PetscInt) {
  void* data = nullptr;
  SNESGetApplicationContext(snes, &data);
  auto& context = *static_cast<Context*>(data);
  return context.guard([&] {
    ::Vec x = nullptr;
    check(SNESGetSolution(snes, &x), "SNESGetSolution");
    context.callbacks.accept(Vector(x));
  });
}

PetscErrorCode judge(::SNES snes, PetscInt iteration, PetscReal, PetscReal, PetscReal norm,
                     SNESConvergedReason* reason, void* data) {
  auto& context = *static_cast<Context*>(data);
  return context.guard([&] {
    *reason = SNES_CONVERGED_ITERATING;
    if (!std::isfinite(norm)) {
      *reason = SNES_DIVERGED_FNORM_NAN;
      return;
    }
    ::Vec f = nullptr, dx = nullptr;
    check(SNESGetFunction(snes, &f, nullptr, nullptr), "SNESGetFunction");
    check(SNESGetSolutionUpdate(snes, &dx), "SNESGetSolutionUpdate");
    const Verdict verdict = context.callbacks.verdict(iteration, Vector(f), Vector(dx));
    if (verdict == Verdict::converged) *reason = SNES_CONVERGED_FNORM_RELATIVE;
    if (verdict == Verdict::diverged) *reason = SNES_DIVERGED_DTOL;
  });
}

/// Whether null pivots leave a part of f that no y balances: K y = f has no solution.
bool inconsistent(const Context& context, ::Vec y, ::Vec f) {
  if (context.solver.inertia().null == 0) return false;
  ::Vec rest = nullptr;
  check(VecDuplicate(f, &rest), "VecDuplicate");
  check(MatMult(context.tangent.handle(), y, rest), "MatMult");
  check(VecAXPY(rest, -1, f), "VecAXPY");
  const bool result = Vector(rest).norm() > 1e-6 * Vector(f).norm();
  check(VecDestroy(&rest), "VecDestroy");
  return result;
}

/// SNES steps are x - t y with K y = f, so the increment is dx = -y and -f(x + t dx) . dx = f . y.
PetscErrorCode search_line(::SNESLineSearch search, void* data) {
  auto& context = *static_cast<Context*>(data);
  return context.guard([&] {
    ::Vec x = nullptr, f = nullptr, y = nullptr, w = nullptr, g = nullptr;
    check(SNESLineSearchGetVecs(search, &x, &f, &y, &w, &g), "SNESLineSearchGetVecs");
    if (context.stiffening == 0 && inconsistent(context, y, f)) {
      if (!stiffen(context)) {
        context.singular = true;
        check(SNESLineSearchSetReason(search, SNES_LINESEARCH_FAILED_REDUCT), "SNESLineSearchSetReason");
        return;
      }
      Vector step(y);
      context.solver.solve(Vector(f), step);
    }
    if (context.stiffening == 0 && context.callbacks.correct) {
      Vector step(y);
      context.callbacks.correct(Vector(f), step);
    }
    double evaluated = -1;
    const auto slope = [&](double t) {
      check(VecWAXPY(w, -t, y, x), "VecWAXPY");
      Vector residual(g);
      context.callbacks.residual(Vector(w), residual);
      evaluated = t;
      return residual.dot(Vector(y));
    };
    const double t = context.callbacks.line_search(slope, Vector(f).dot(Vector(y)), context.stiffening > 0);
    if (t != evaluated) slope(t);
    check(VecCopy(w, x), "VecCopy");
    check(VecCopy(g, f), "VecCopy");
    check(VecScale(y, t), "VecScale");
    check(SNESLineSearchSetLambda(search, t), "SNESLineSearchSetLambda");
    check(SNESLineSearchComputeNorms(search), "SNESLineSearchComputeNorms");
    check(SNESLineSearchSetReason(search, SNES_LINESEARCH_SUCCEEDED), "SNESLineSearchSetReason");
  });
}

PetscErrorCode before_solve(::KSP, ::Vec, ::Vec, void* data) {
  static_cast<Context*>(data)->solve_start = std::chrono::steady_clock::now();
  return 0;
}

PetscErrorCode after_solve(::KSP, ::Vec, ::Vec, void* data) {
  auto& context = *static_cast<Context*>(data);
  context.solver.count_solve(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - context.solve_start).count());
  return 0;
}

/// Owns a SNES for one solve.
class Handle {
 public:
  Handle() { check(SNESCreate(PETSC_COMM_WORLD, &snes_), "SNESCreate"); }
  /// SNES would reset the solver's KSP on its way out and so lose the factors, their analysis and options.
  ~Handle() {
    ::KSP other = nullptr;
    if (KSPCreate(PETSC_COMM_WORLD, &other) == 0) SNESSetKSP(snes_, other);
    KSPDestroy(&other);
    SNESDestroy(&snes_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ::SNES get() const { return snes_; }

 private:
  ::SNES snes_ = nullptr;
};

void configure(::SNES snes, Context& context, ::Vec residual, int max_iterations) {
  check(SNESSetType(snes, SNESNEWTONLS), "SNESSetType");
  check(SNESSetApplicationContext(snes, &context), "SNESSetApplicationContext");
  check(SNESSetKSP(snes, context.solver.handle()), "SNESSetKSP");
  check(SNESSetFunction(snes, residual, form_residual, &context), "SNESSetFunction");
  check(SNESSetJacobian(snes, context.tangent.handle(), context.tangent.handle(), form_tangent, &context),
        "SNESSetJacobian");
  check(SNESSetUpdate(snes, start_iteration), "SNESSetUpdate");
  check(SNESSetConvergenceTest(snes, judge, &context, nullptr), "SNESSetConvergenceTest");
  check(SNESSetTolerances(snes, 0, 0, 0, max_iterations, 1000000), "SNESSetTolerances");
  check(SNESSetDivergenceTolerance(snes, -1), "SNESSetDivergenceTolerance");
  check(KSPSetPreSolve(context.solver.handle(), before_solve, &context), "KSPSetPreSolve");
  check(KSPSetPostSolve(context.solver.handle(), after_solve, &context), "KSPSetPostSolve");
  ::SNESLineSearch search = nullptr;
  check(SNESGetLineSearch(snes, &search), "SNESGetLineSearch");
  check(SNESLineSearchSetType(search, SNESLINESEARCHSHELL), "SNESLineSearchSetType");
  check(SNESLineSearchShellSetUserFunc(search, search_line, &context), "SNESLineSearchShellSetUserFunc");
}

}  // namespace

SnesOutcome run_snes(const SnesCallbacks& callbacks, SymmetricMatrix& tangent, DirectSolver& solver,
                     Vector& x, int max_iterations) {
  Context context{callbacks, tangent, solver, nullptr};
  const Handle snes;
  ::Vec residual = nullptr;
  check(VecDuplicate(x.handle(), &residual), "VecDuplicate");
  configure(snes.get(), context, residual, max_iterations);
  const PetscErrorCode code = SNESSolve(snes.get(), nullptr, x.handle());
  VecDestroy(&residual);
  KSPSetPreSolve(solver.handle(), nullptr, nullptr);
  KSPSetPostSolve(solver.handle(), nullptr, nullptr);
  if (context.error) std::rethrow_exception(context.error);
  check(code, "SNESSolve");
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetConvergedReason(snes.get(), &reason), "SNESGetConvergedReason");
  if (context.stiffening > 0) {  // who asks for the inertia means the tangent's
    tangent.shift(-context.stiffening);
    solver.factor(tangent);
  }
  if (reason > 0) {
    callbacks.accept(x);
    return SnesOutcome::converged;
  }
  if (context.singular || context.stiffening > 0) return SnesOutcome::singular;
  return reason == SNES_DIVERGED_FNORM_NAN ? SnesOutcome::not_a_number : SnesOutcome::diverged;
}

}  // namespace tautline::la
