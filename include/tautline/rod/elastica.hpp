#pragma once
/// @file
/// Euler's elastica: a cantilever of length 1 and EI = 1 compressed at its end beyond buckling, in closed
/// form. It verifies the models of this module. Theory: docs/theory/rod.md

namespace tautline::rod {

/// X' = cos theta, Y' = sin theta, theta'' = -nu sin theta, theta(0) = 0, theta'(1) = 0 with theta > 0 first.
class Elastica {
 public:
  /// @param nu R l^2 / EI [-]
  /// @param mode 1 for the shape buckled first, which is stable; j bends j - 1 times more
  /// @throws ModelError unless nu > ((2 mode - 1) pi / 2)^2
  explicit Elastica(double nu, int mode = 1);
  double angle(double s) const;  ///< [rad]
  double end_x() const;          ///< X(1)
  double end_y() const;          ///< Y(1)

 private:
  double root_nu_;
  double modulus_;  ///< k with (2 mode - 1) K(k) = sqrt(nu)
};

}  // namespace tautline::rod
