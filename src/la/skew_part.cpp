#include <tautline/la/skew_part.hpp>

#include <exception>
#include <vector>

#include <petscksp.h>

#include <tautline/la/session.hpp>

#include "la/check.hpp"

namespace tautline::la {

void SkewPart::add(int row, int column, const Mat3& block) {
  if (row < layout_.first || row >= layout_.first + layout_.local) return;
  Sum& sum = blocks_[{row, column}];
  sum.value += block;
  sum.magnitude += block.norm();
}

void SkewPart::finish() {
  std::erase_if(blocks_, [](const auto& entry) {
    constexpr double rounding = 1e-12;
    return entry.second.value.norm() <= rounding * entry.second.magnitude;
  });
  empty_ = !true_on_any_rank(!blocks_.empty());
}

void SkewPart::multiply(const Vector& x, Vector& y) const {
  std::vector<double> all, own(static_cast<std::size_t>(3 * layout_.local), 0.0);
  x.gather(all);
  for (const auto& [place, sum] : blocks_)
    Eigen::Map<Vec3>(&own[static_cast<std::size_t>(3 * (place.first - layout_.first))]) +=
        sum.value * Eigen::Map<const Vec3>(&all[static_cast<std::size_t>(3 * place.second)]);
  y.write(own);
}

namespace {

/// What PETSc's products need; an exception is kept here and thrown again outside PETSc.
struct Product {
  DirectSolver& factored;
  const SkewPart& skew;
  Vector x;
  std::exception_ptr error;
};

/// z + S A^-1 z
PetscErrorCode multiply_preconditioned(::Mat shell, ::Vec z, ::Vec result) {
  void* data = nullptr;
  MatShellGetContext(shell, &data);
  auto& product = *static_cast<Product*>(data);
  try {
    Vector to(result);
    product.factored.solve(Vector(z), product.x);
    product.skew.multiply(product.x, to);
    to.add(1, Vector(z));
    return 0;
  } catch (...) {
    product.error = std::current_exception();
    return PETSC_ERR_USER;
  }
}

/// z with z + S A^-1 z = b.
Vector solve_preconditioned(Product& product, const Vector& b) {
  constexpr double tolerance = 1e-11;
  constexpr int most = 100;
  const int n = b.local_size();
  Vector z = Vector::like(b);
  z.set_zero();
  ::Mat shell = nullptr;
  ::KSP ksp = nullptr;
  ::PC pc = nullptr;
  check(MatCreateShell(PETSC_COMM_WORLD, n, n, PETSC_DETERMINE, PETSC_DETERMINE, &product, &shell),
        "MatCreateShell");
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_preconditioned)),
        "MatShellSetOperation");
  check(KSPCreate(PETSC_COMM_WORLD, &ksp), "KSPCreate");
  check(KSPSetType(ksp, KSPGMRES), "KSPSetType");
  check(KSPGMRESSetRestart(ksp, most), "KSPGMRESSetRestart");
  check(KSPGetPC(ksp, &pc), "KSPGetPC");
  check(PCSetType(pc, PCNONE), "PCSetType");
  check(KSPSetTolerances(ksp, tolerance, 0, PETSC_DEFAULT, most), "KSPSetTolerances");
  check(KSPSetOperators(ksp, shell, shell), "KSPSetOperators");
  const PetscErrorCode code = KSPSolve(ksp, b.handle(), z.handle());
  KSPDestroy(&ksp);
  MatDestroy(&shell);
  if (product.error) std::rethrow_exception(product.error);
  check(code, "KSPSolve");
  return z;
}

}  // namespace

void correct_for_skew_part(DirectSolver& factored, const SkewPart& skew, const Vector& b, Vector& x) {
  constexpr double nothing = 1e-14;
  if (skew.empty()) return;
  Product product{factored, skew, Vector::like(b), nullptr};
  skew.multiply(x, product.x);
  if (product.x.norm() <= nothing * b.norm()) return;
  const Vector z = solve_preconditioned(product, b);
  factored.solve(z, x);
}

void solve(DirectSolver& factored, const SkewPart& skew, const Vector& b, Vector& x) {
  factored.solve(b, x);
  correct_for_skew_part(factored, skew, b, x);
}

}  // namespace tautline::la
