#pragma once
/// @file
/// What each deck step can be told. One struct for a step kind; a deck's `steps` is a list of these.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tautline/analysis/arc_length_options.hpp>
#include <tautline/analysis/newton_options.hpp>
#include <tautline/assembly/mass_options.hpp>
#include <tautline/core/error.hpp>
#include <tautline/model/subdivide.hpp>
#include <tautline/reflector/tuning_options.hpp>
#include <tautline/rod/rod_options.hpp>
#include <tautline/steps/form_finding_options.hpp>

namespace tautline::steps {

/// `kind: mesh`
struct MeshOptions {
  model::SubdivideOptions subdivide;
};

/// One stage of an equilibrium: the supports plus `hold` are kept.
struct StageOptions {
  std::string name;
  std::vector<std::string> hold;  ///< groups or selections held besides the deck's supports
  SourceLocation where;
};

/// How the last stage of an equilibrium is followed.
enum class Control { load, arc_length };

/// A coordinate direction.
enum class Axis { x, y, z };

/// Where a path that is followed by its length ends, beside ArcLengthOptions.
struct UntilOptions {
  double load_factor = 1;
  std::optional<double> least_load_factor;
  std::vector<std::string> on;  ///< groups or selections whose mean displacement is watched
  Axis direction = Axis::z;
  std::optional<double> displacement;  ///< from the reference configuration [m]
};

/// Who chooses the stages of a release.
enum class Release { as_given, automatic };

/// What is tried where Newton's method fails. Automatic: descent, as long as no equilibrium is known.
enum class Fallback { automatic, none, descent, dynamic_relaxation };

/// What holds the structure in a step: the deck's supports, or nothing, so that it floats.
enum class Ground { deck, free };

/// Random changes at the start.
struct ScatterOptions {
  double position = 0;  ///< largest displacement of a free node, in each coordinate [m]
  double tension = 0;   ///< largest change of a cable's initial strain, over it [-]
  int seed = 1;
};

/// `kind: equilibrium`
struct EquilibriumOptions {
  std::vector<StageOptions> stages;  ///< empty: one stage with the supports only
  /// Names of the loads ramped up in the last stage, which act from then on; not given: all of the deck.
  std::optional<std::vector<std::string>> loads;
  bool reset = false;                ///< start again from the reference configuration (as form-found)
  bool allow_unstable = false;       ///< the step is done also in an unstable equilibrium
  int increments = 1;                ///< the last stage comes to rest at lambda = 1/n, 2/n, ..., 1
  std::vector<std::string> monitor;  ///< groups or selections whose motion is reported at every rest
  Control control = Control::load;
  analysis::ArcLengthOptions arc_length;
  UntilOptions until;
  Release release = Release::as_given;
  Fallback fallback = Fallback::automatic;
  ScatterOptions scatter;
  Ground support = Ground::deck;  ///< free: accelerated by what acts (inertia relief)
};

/// `kind: buckling`
struct BucklingOptions {
  /// Loads that are scaled; not given: all of the deck that do not act yet.
  std::optional<std::vector<std::string>> loads;
  int modes = 3;
  enum class Sign { both, positive, negative } sign = Sign::both;
};

/// A shape made wrong, in the form of a mode of linear buckling.
struct ImperfectionOptions {
  int mode = 1;          ///< by its positive factor, the least first
  double amplitude = 0;  ///< largest displacement of a node; negative: to the other side [m]
};

/// `kind: collapse`
struct CollapseOptions {
  std::optional<std::vector<std::string>> loads;  ///< as in BucklingOptions, without `disturbance`
  std::vector<std::string> disturbance;           ///< loads that act in full from the start
  ImperfectionOptions imperfection;               ///< of the structure that the rule follows
  std::vector<std::string> monitor;               ///< whose motion tells
  double step = 0.05;                             ///< over the linear buckling load [-]
  double growth = 1.5;                            ///< of the monitored displacement in one step
  std::optional<double> linear_factor;            ///< not given: by linear buckling
  double last = 1.2;                              ///< the loads go no farther, over the linear buckling load
  analysis::ArcLengthOptions arc_length;  ///< for the limit or bifurcation of the undisturbed structure
  std::vector<double> working_forces;     ///< compressions of members in service [N]
};

/// `kind: tuning`
struct TuningStepOptions {
  reflector::TuningOptions tuning;
};

/// `kind: modal`
struct ModalOptions {
  int modes = 6;  ///< elastic ones: those of a rigid body are counted, not listed
  assembly::MassKind mass = assembly::MassKind::consistent;
  Ground support = Ground::deck;
};

/// `kind: rod_shaping`, on a rod-umbrella
struct RodShapingOptions {
  enum class Method { exact, cantilevers } method = Method::exact;
  rod::ExactOptions exact;
  rod::CantileverOptions cantilevers;
  std::optional<double> tolerance;    ///< of the method; not given: its own default
  std::optional<int> max_iterations;  ///< likewise
  /// E_T F_k of cables that are given, with the rods turned to the stop; not given: cables are looked for [N]
  std::optional<std::vector<double>> stiffness;
  /// Constant forces on the nodes towards the axis, in place of cables [N].
  std::optional<std::vector<double>> reaction;
  double start_angle = 0;  ///< with `reaction`: bend of the whole rod that the search begins from [degree]
};

/// What each of some nodes is asked for; coordinates not given are free.
struct InverseTargetOptions {
  std::vector<std::string> on;                   ///< groups or selections
  std::optional<double> x, y, z;                 ///< coordinates [m]
  std::optional<double> radius;                  ///< distance from the z axis [m]
  std::optional<rod::MeridianOptions> meridian;  ///< to lie on the curve's surface of revolution about z
  double weight = 1;                             ///< of its misses in the sum of squares, before squaring
  SourceLocation where;
};

/// Cables that may be changed.
struct InverseUnknownOptions {
  enum class Quantity { unstressed_length, axial_stiffness };
  enum class Each { group, cable };
  std::vector<std::string> on;  ///< groups or selections
  Quantity quantity = Quantity::unstressed_length;
  Each each = Each::group;         ///< one unknown for each name, a common factor; or one for each cable
  std::optional<double> min, max;  ///< of the quantity [m] or [N]; none: a thousandth of the start, no limit
  SourceLocation where;
};

/// `kind: inverse`, from an equilibrium
struct InverseOptions {
  std::vector<InverseTargetOptions> targets;
  std::vector<InverseUnknownOptions> unknowns;
  double tolerance = 1e-6;       ///< largest weighted miss of a target that is met [m]
  double rank_tolerance = 1e-8;  ///< singular values below this part of the largest count as zero
  int max_iterations = 50;
};

using AnyStep =
    std::variant<FormFindingOptions, MeshOptions, EquilibriumOptions, TuningStepOptions, ModalOptions,
                 BucklingOptions, CollapseOptions, RodShapingOptions, InverseOptions>;

struct Step {
  std::string kind;  ///< as written in the deck
  std::string name;  ///< given, or kind with a number where a kind repeats; unique
  SourceLocation where;
  AnyStep options;
};

}  // namespace tautline::steps
