#pragma once
/// @file
/// Newton's method for small dense systems, derivatives by complex steps, and the path that turns the root.

#include <complex>
#include <functional>
#include <string>

#include <tautline/core/types.hpp>
#include <tautline/rod/solve_summary.hpp>

namespace tautline::rod {

using Complex = std::complex<double>;
using VecC = Eigen::VectorXcd;

/// The summary with its end.
SolveSummary ended(SolveSummary summary, SolveStatus status, std::string reason);

/// A residual of comparable, dimensionless entries and its derivative by the unknowns.
struct Linearised {
  VecX residual;
  MatX jacobian;
};

/// @brief Solves residual(x) = 0 from x; x holds the last iterate afterwards. Steps are halved while the
/// residual does not fall.
/// @param size of each unknown, for measuring increments
SolveSummary solve_newton(const std::function<Linearised(const VecX&)>& problem, const VecX& size,
                          double tolerance, int max_iterations, VecX& x);

/// Value and Jacobian of an analytic f: C^n -> C^n by complex steps, exact to rounding (Squire & Trapp 1998).
template <class F>
Linearised complex_step(const F& f, const VecX& x) {
  constexpr double h = 1e-40;
  VecC z = x.cast<Complex>();
  Linearised out{f(z).real(), {}};
  out.jacobian.resize(out.residual.size(), x.size());
  for (int j = 0; j < x.size(); ++j) {
    z[j] += Complex(0, h);
    out.jacobian.col(j) = f(z).imag() / h;
    z[j] = x[j];
  }
  return out;
}

/// @brief Follows x from turn = 0, where it is a solution, to turn = 1 with cables of given stiffnesses;
/// steps are halved twice on failure and doubled on success. x is left at the last point reached.
SolveSummary follow_turning(const VecX& stiffness,
                            const std::function<SolveSummary(double turn, VecX& x)>& solve_at,
                            double min_step, VecX& x);

}  // namespace tautline::rod
