#pragma once
#include <limits>
#include <string>
#include <vector>

namespace tautline::rod {

enum class MeridianKind {
  parabola,   ///< Y = coefficient X^2
  table,      ///< monotone cubics through points
  expression  ///< a formula of X
};

/// The curve Y = F(X) whose rotation about the axis Y is the surface wanted; X is the distance from the axis.
struct MeridianOptions {
  MeridianKind kind = MeridianKind::parabola;
  double coefficient = 0;    ///< lambda of the parabola [1/m]
  std::vector<double> x, y;  ///< points of the table, x rising [m]
  std::string expression;    ///< F as a formula of X, see tautline::Expression [m]
};

enum class CableLaw {
  linear,   ///< tension E_T F eps
  bilinear  ///< a second slope beyond the knee
};

/// What a cable of a parallel does when stretched. Slack cables carry nothing under either law.
struct CableOptions {
  CableLaw law = CableLaw::linear;
  double knee_strain = std::numeric_limits<double>::infinity();  ///< bilinear: where the slope changes [-]
  double second_slope = 1;     ///< bilinear: slope beyond the knee as a part of E_T F [-]
  double strain_limit = 0.05;  ///< a larger strain is warned of: high-modulus fibres break at 2-4 % [-]
};

/// An umbrella of equal rods without a net. Lists of links go from the root outwards; a list with one entry
/// means the same for all.
struct UmbrellaOptions {
  int rods = 24;                          ///< n
  int links = 4;                          ///< m
  std::vector<double> lengths;            ///< a_k [m]
  std::vector<double> bending_stiffness;  ///< EI_k [N m2]
  double root_radius = 0.25;              ///< a_0, from the axis to the root of the flexible part [m]
  double root_offset = 0;                 ///< delta_0, by which the straight rod's hinge is nearer to it [m]
  double straight_angle = 60;             ///< beta_0, from X to the straight rods, cables just taut [degree]
  MeridianOptions meridian;
  CableOptions cable;
  // Of the rods as beams in space.
  std::vector<double> axial_stiffness{1e10};  ///< EA of the links; large: as good as inextensible [N]
  std::vector<double> mass_per_length{0.0};   ///< of the links [kg/m]
  std::vector<double> torsion_stiffness;      ///< GJ of the links; empty: EI / 1.3, a round section [N m2]
};

/// Quadratic shortening of a bent link, u = -(6/5 v^2/a - c1 v theta + c2 a theta^2) / 2.
enum class Shortening {
  as_published,  ///< c1 = 1/10, c2 = 1/15, as printed and used by Russkikh & Shklyarchuk (2021)
  consistent     ///< c1 = 1/5, c2 = 2/15, the integral of v'^2
};

enum class CantileverMethod {
  newton,
  successive  ///< the paper's successive approximation; does not converge for many links
};

/// The paper's model: one cantilever element for each link.
struct CantileverOptions {
  Shortening shortening = Shortening::consistent;
  CantileverMethod method = CantileverMethod::newton;
  double tolerance = 1e-9;    ///< largest change of an angle in the last iteration [rad]
  int max_iterations = 2000;  ///< Newton's method stops after 50 at most
};

/// Which conditions an inextensible rod meets at its nodes.
enum class ExactForm {
  nodes_on_surface,  ///< form A: lengths given, nodes anywhere on the surface
  nodes_on_target    ///< form B: nodes where the target has them, lengths free
};

/// The exact rod.
struct ExactOptions {
  ExactForm form = ExactForm::nodes_on_surface;
  double tolerance = 1e-10;  ///< largest change of an unknown in the last iteration, relative to its size [-]
  int max_iterations = 50;
  double min_step = 1e-4;  ///< smallest step in turning the root from the straight rod to the stop [-]
};

}  // namespace tautline::rod
