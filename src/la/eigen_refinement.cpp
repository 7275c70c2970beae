#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <petscvec.h>

#include <tautline/core/error.hpp>

#include "la/check.hpp"
#include "la/eigen_refinement.hpp"

namespace tautline::la {

namespace {

long double dot(const std::vector<double>& a, const std::vector<long double>& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Sharpens one mode after another; lower modes are kept out of higher ones.
class Refinement {
 public:
  Refinement(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, DirectSolver& solver)
      : stiffness_(stiffness), mass_(mass), solver_(solver), scale_(stiffness.norm_of_diagonal()) {}

  /// @return eigenvalue and residual of the sharpened mode
  std::pair<double, double> refine(Vector& mode) {
    std::vector<double> x;
    mode.gather(x);
    long double value = normalise(x);
    for (int round = 0; round < rounds; ++round) {
      correct(mode, x, value);
      value = normalise(x);
    }
    mode.write(own(mode, x));
    keep_out(x);
    return {static_cast<double>(value), residual(x, value)};
  }
  /// Of all modes to come.
  void keep_out(const std::vector<double>& x) {
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
    Vector right = Vector::like(mode);
    right.write(own(mode, imbalance(x, value)));
    solver_.solve(right, mode);
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
  DirectSolver& solver_;
  double scale_;
  std::vector<std::vector<double>> lower_;
  std::vector<std::vector<long double>> lower_mass_;
};

}  // namespace

void refine(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double shift,
            const std::vector<Vector>& known, EigenPairs& pairs) {
  DirectSolver solver;
  const SymmetricMatrix shifted = stiffness.plus(-shift, mass);
  if (!solver.factor(shifted)) throw LibraryError(solver.failure());
  Refinement refinement(stiffness, mass, solver);
  for (const auto& vector : known) {
    std::vector<double> x;
    vector.gather(x);
    refinement.keep_out(x);
  }
  for (std::size_t i = 0; i < pairs.vectors.size(); ++i)
    std::tie(pairs.values[i], pairs.residuals[i]) = refinement.refine(pairs.vectors[i]);
  pairs.timings = solver.timings();
}

}  // namespace tautline::la
