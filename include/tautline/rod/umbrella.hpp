#pragma once
/// @file
/// One rod of the umbrella in its meridian plane, its cables and its target. X points away from the axis, Y
/// along it. Source: Russkikh & Shklyarchuk (2021), sections 2, 3. Theory: docs/theory/rod.md

#include <tautline/core/types.hpp>
#include <tautline/rod/meridian.hpp>
#include <tautline/rod/rod_options.hpp>

namespace tautline::rod {

/// Where a rod is clamped.
struct Root {
  double x = 0, y = 0;  ///< [m]
  double angle = 0;     ///< theta_0, from X to the rod's tangent [rad]
};

/// An inextensible rod of links, straight when free. Nodes k = 1..m are the ends of the links and have index
/// k - 1 in every vector.
struct Rod {
  VecX lengths;            ///< a_k [m]
  VecX bending_stiffness;  ///< EI_k [N m2]
  Root root;
  int links() const { return static_cast<int>(lengths.size()); }
};

/// A force and its derivative by what it depends on.
struct Force {
  double value = 0, slope = 0;
};

/// Tension over stiffness E_T F at a strain, and its slope [-].
Force tension_ratio(const CableOptions& cable, double strain);

/// The cables of the m parallels, seen from one rod: a cable pulls its node towards the axis.
struct Cables {
  int rods = 0;
  CableOptions options;
  VecX straight_radius;  ///< X_k', at which the cables begin to pull [m]
  VecX stiffness;        ///< E_T F_k [N]

  double strain(int k, double x) const { return x / straight_radius[k] - 1; }
  /// R_k = 2 T_k sin(pi/n), eq. (3.5), and dR_k/dX_k.
  Force reaction(int k, double x) const;
  /// dR_k/dX_k of cables that give these reactions at radii x; zero where a cable cannot [N/m].
  VecX slopes(const VecX& x, const VecX& reactions) const;
};

/// E_T F_k of cables that give `reactions` [N] at the radii x [m], NaN where a cable cannot: slack, or to
/// push.
VecX stiffness_for(const Cables& cables, const VecX& x, const VecX& reactions);

/// The umbrella with everything that follows from its options.
struct Umbrella {
  Meridian meridian;
  Rod rod;
  Cables cables;                          ///< without stiffnesses
  double hinge_radius;                    ///< a_0 - delta_0, of the root on the straight rod [m]
  double straight_angle;                  ///< beta_0 [rad]
  VecX target_x, target_y, target_angle;  ///< nodes on the meridian, the a_k apart along it

  /// X_k' of a rod with other lengths: (a_0 - delta_0 + sum a_i) cos beta_0 [m].
  VecX straight_radius(const VecX& lengths) const;
  /// The root while it turns: the straight rod at 0, the stop at 1.
  Root root_at(double turn) const;
};

/// @throws ModelError with the reason where the options make no umbrella
Umbrella make_umbrella(const UmbrellaOptions& options);
/// With any meridian; the one in the options is not looked at. @throws ModelError as above
Umbrella make_umbrella(const UmbrellaOptions& options, Meridian meridian);

}  // namespace tautline::rod
