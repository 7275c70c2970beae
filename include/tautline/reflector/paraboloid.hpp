#pragma once
/// @file
/// The reflecting surface. Source: Belov (2021), eqs 3.4-3.8. Theory: docs/theory/paraboloid.md

#include <tautline/core/types.hpp>
#include <tautline/formfinding/net.hpp>
#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// Offset (or, with clearance = -aperture/2, axisymmetric) paraboloid in the aperture frame: z normal to the
/// aperture plane of the cut-out, x in the plane of symmetry.
class Paraboloid : public formfinding::Surface {
 public:
  /// @param aperture D, diameter of the cutting cylinder [m]
  /// @param focal_length F [m]
  /// @param clearance X_A, distance from the parent axis to the near edge [m]; -aperture/2 gives the
  /// axisymmetric dish
  /// @param raised by so much along z [m]
  /// @throws ModelError unless aperture, focal_length > 0 and clearance >= -aperture/2
  Paraboloid(double aperture, double focal_length, double clearance, double raised = 0);

  double aperture() const noexcept { return aperture_; }
  double focal_length() const noexcept { return focal_length_; }
  /// Tilt of the aperture frame, phi [rad].
  double tilt() const noexcept { return tilt_; }
  /// z by the stable smaller root (eqs 3.6, 3.8) [m].
  double height(double x, double y) const;
  Vec3 height_and_slope(double x, double y) const override;
  /// Unit vector of the parent paraboloid's axis (towards the focus) in the aperture frame.
  Vec3 axis() const;
  /// Point of the aperture frame in the parent frame (vertex at the origin, axis z) [m].
  Vec3 to_parent(const Vec3& point) const;

 private:
  double aperture_, focal_length_, offset_, raised_, tilt_, shift_;
};

/// The surface that the options describe. @throws ModelError
Paraboloid make_paraboloid(const DishOptions& options);

}  // namespace tautline::reflector
