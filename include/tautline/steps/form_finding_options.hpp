#pragma once
/// @file
/// What a deck can ask of stage 1.

#include <array>
#include <optional>
#include <string>
#include <tautline/core/error.hpp>
#include <tautline/core/types.hpp>
#include <tautline/formfinding/constrained_options.hpp>
#include <tautline/formfinding/constraint_options.hpp>
#include <tautline/formfinding/dynamic_relaxation_options.hpp>
#include <tautline/formfinding/force_density_options.hpp>
#include <tautline/formfinding/guide_options.hpp>
#include <tautline/formfinding/tolerance_options.hpp>
#include <vector>

namespace tautline::steps {

enum class FormMethod {
  tension,      ///< a tension for every group that states one; those that state a force density keep it
  linear,       ///< given force densities
  balanced,     ///< force densities that balance the drawn shape, tensions near those of the groups
  constraints,  ///< any mixture of tensions, lengths and reactions
  elastic,      ///< elastic cables of given unstressed lengths
  dynamic_relaxation,  ///< elastic cables, cables of constant tension and films, by a damped motion
  film,                ///< soap films of given stress with cables
  self_stress          ///< forces in balance with each other in the shape drawn, of cables and bars
};

/// How the equations are solved; which of them a method knows is checked by the deck.
enum class FormSolver { automatic, smallest_norm, dense, lsqr, position_newton, fixed_point };

/// `constraints` of a form_finding step.
struct FormConstraintOptions {
  formfinding::ConstraintKind kind = formfinding::ConstraintKind::tension;
  std::vector<std::string> on;     ///< cable groups; for reactions groups of nodes
  std::vector<double> value;       ///< one for all or one for each
  std::optional<double> min, max;  ///< in place of a value: what is found shall lie between
  double weight = 1;               ///< of the squares of the relative deviations
  SourceLocation where;
};

/// `bounds` of a form_finding step.
struct FormBoundsOptions {
  std::vector<std::string> on;     ///< cable groups
  std::optional<double> min, max;  ///< of the force densities [N/m]
  std::optional<double> weight;    ///< of a soft bound; without one the bound is kept
  SourceLocation where;
};

/// `guides` of a form_finding step: nodes that slide along a line or in a plane through where they are drawn.
struct FormGuideOptions {
  std::vector<std::string> on;
  formfinding::GuideKind kind = formfinding::GuideKind::line;
  Vec3 direction = Vec3::UnitX();  ///< along the line, or normal to the plane
  std::optional<Vec3> point;       ///< another point of the line or plane [m]
  SourceLocation where;
};

/// What the net is hung in: all that is neither net nor cloth.
enum class FrameKind {
  rigid,       ///< nodes that stay
  elastic,     ///< made as drawn, yields under the net
  precambered  ///< as drawn under the net; the shape without stress is looked for
};

/// How the rear net of a reflector is found.
enum class RearForm {
  mirrored,  ///< it is the front net's mirror image
  tension,   ///< by itself, under the pull of the ties: for the tensions of its groups
  balanced   ///< by itself: force densities that balance the mirror image of the front net's nodes best
};

enum class FormSurfaceKind { plane, paraboloid, table };

/// `surface` of a form_finding step on a plain model.
struct FormSurfaceOptions {
  FormSurfaceKind kind = FormSurfaceKind::plane;
  double height = 0;                   ///< plane: at x = y = 0; paraboloid: of the vertex [m]
  std::array<double, 2> slope{0, 0};   ///< plane: dz/dx, dz/dy
  std::array<double, 2> centre{0, 0};  ///< paraboloid: x, y of the vertex [m]
  std::optional<double>
      focal_length;          ///< paraboloid: z = height + r^2 / (4 F) [m]; negative: opens downwards
  std::vector<double> x, y;  ///< table: grid lines [m]
  std::vector<std::vector<double>> heights;  ///< table: a row for each x, an entry for each y [m]
};

/// `length_errors` of a form_finding step.
struct LengthErrorOptions {
  double sigma = 0;  ///< standard deviation of every unstressed length [m]
  formfinding::ToleranceOptions sampling;
};

/// `kind: form_finding`. On a reflector: `net` is bound to the paraboloid, mirrored to the rear, `ties` get
/// the vertical residual. On a plain model: `net` in space or on `surface`, fixed where supports and other
/// elements' nodes are.
struct FormFindingOptions {
  std::vector<std::string>
      net;  ///< cable groups; empty: front_... of a reflector, all cable groups otherwise
  std::vector<std::string>
      fixed;  ///< groups or selections whose nodes are fixed besides the supports (plain models)
  std::optional<std::vector<std::string>>
      cloth;  ///< membranes that pull; not given: all with films, else none
  FrameKind frame = FrameKind::rigid;
  std::optional<RearForm> rear;  ///< reflectors; not given: balanced where the patterns differ, else mirrored
  std::vector<std::string> loads;  ///< whose nodal forces act
  FormMethod method = FormMethod::tension;
  FormSolver solver = FormSolver::automatic;
  formfinding::SurfaceJacobian jacobian = formfinding::SurfaceJacobian::consistent;
  double initial_force_density = 10.0;  ///< of branches without one of their own [N/m]
  std::optional<double> tolerance;      ///< of the method; not given: its own default
  std::optional<int> max_iterations;    ///< likewise
  bool condition_number = false;
  std::vector<FormConstraintOptions> constraints;
  std::vector<std::string> hold;  ///< groups that keep their force densities
  std::vector<FormBoundsOptions> bounds;
  std::vector<FormGuideOptions> guides;
  std::optional<FormSurfaceOptions> surface;
  std::vector<std::string> on_surface;        ///< groups whose free nodes lie on it; empty: all
  std::vector<std::string> ties;              ///< plain models: cable groups that hold the net on the surface
  std::vector<std::string> constant_tension;  ///< dynamic relaxation: groups that keep their tension
  formfinding::DynamicRelaxationOptions relaxation;
  std::optional<LengthErrorOptions> length_errors;
};

}  // namespace tautline::steps
