#pragma once
/// @file
/// Newton's iteration on the force densities until all rows of constraints are met.

#include <formfinding/constraint.hpp>
#include <formfinding/jacobian.hpp>
#include <formfinding/lsqr.hpp>
#include <functional>

namespace tautline::formfinding {

struct SearchSettings {
  double tolerance = 0;  ///< of the largest |missing|
  int max_iterations = 50;
  bool dense = false;  ///< dense decomposition instead of LSQR
  bool z_follows_surface = true;
  std::vector<bool> held;  ///< branches that keep their force density; may be empty
  VecX lower, upper;       ///< bounds of the force densities; may be empty
};

class ConstraintSearch {
 public:
  using MakeRows = std::function<ConstraintRows(const NetState&)>;

  ConstraintSearch(NetSystem& system, MakeRows make_rows, SearchSettings settings)
      : system_(system), make_rows_(std::move(make_rows)), settings_(std::move(settings)) {}

  /// @param[in] after_iteration  called after each iteration
  void run(const VecX& start, const std::function<void()>& after_iteration = {});

  const NetState& state() const noexcept { return now_.state; }
  const ConstraintRows& rows() const noexcept { return now_.rows; }
  const VecX& missing() const noexcept { return now_.missing; }
  double error() const { return now_.missing.size() > 0 ? now_.missing.cwiseAbs().maxCoeff() : 0.0; }
  bool met() const { return error() <= settings_.tolerance; }
  bool stuck() const noexcept { return stuck_; }
  int iterations() const noexcept { return iterations_; }
  int inner_iterations() const noexcept { return inner_iterations_; }
  const std::vector<double>& relaxation() const noexcept { return relaxation_; }

  /// At the present state; factorises there.
  ConstraintJacobian jacobian();
  /// |G r| <= limit |G| |r|: no small change of the free force densities brings the rows nearer.
  bool stationary(double limit);
  /// Extreme singular values (smallest, largest) of the bidiagonal matrix of the last LSQR; zero without one.
  std::array<double, 2> ritz_values() const;

 private:
  struct Trial {
    NetState state;
    ConstraintRows rows;
    VecX missing;
  };

  Trial evaluate(const VecX& force_density);
  bool take_step();
  /// q + alpha dq with the first alpha of eq. (2.25), i = first to last, that satisfies (2.26); false if none
  /// does.
  bool take_relaxed(const VecX& dq, int first, int last);
  bool take(const VecX& dq, double alpha);
  /// Step of Levenberg and Marquardt, for where the relaxed one fails.
  bool take_damped(ConstraintJacobian& jacobian);
  VecX solve_step(const ConstraintJacobian& jacobian, double damping);
  /// The step that respects held branches and bounds; holds those branches in `jacobian`.
  VecX step_within_bounds(ConstraintJacobian& jacobian, double damping);
  VecX within_bounds(VecX force_density) const;

  NetSystem& system_;
  MakeRows make_rows_;
  SearchSettings settings_;
  Trial now_;
  int inertia_ = 0;
  int iterations_ = 0, inner_iterations_ = 0;
  bool stuck_ = false;
  std::vector<double> relaxation_;
  LeastSquares last_;
};

}  // namespace tautline::formfinding
