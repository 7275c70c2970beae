#pragma once
/// @file
/// What each deck step can be told. One struct for a step kind; a deck's `steps` is a list of these.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tautline/analysis/newton_options.hpp>
#include <tautline/assembly/mass_options.hpp>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/force_density_options.hpp>
#include <tautline/model/subdivide.hpp>
#include <tautline/reflector/tuning_options.hpp>
#include <tautline/rod/rod_options.hpp>

namespace tautline::steps {

/// `kind: form_finding`. On a reflector: `net` is bound to the paraboloid, mirrored to `mirror`, `ties` get
/// the vertical residual. On a plain model: `net` in space, fixed where supports and other elements' nodes
/// are.
struct FormFindingOptions {
  std::vector<std::string>
      net;  ///< cable groups; empty: front_net of a reflector, all cable groups otherwise
  std::vector<std::string>
      fixed;  ///< groups or selections whose nodes are fixed besides the supports (plain models)
  enum class Method {
    tension,
    linear
  } method = Method::tension;  ///< prescribed tensions, or given force densities
  formfinding::ForceDensityOptions solver;
};

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

/// `kind: equilibrium`
struct EquilibriumOptions {
  std::vector<StageOptions> stages;  ///< empty: one stage with the supports only
  /// Names of the loads ramped up in the last stage, which act from then on; not given: all of the deck.
  std::optional<std::vector<std::string>> loads;
  bool reset = false;                ///< start again from the reference configuration (as form-found)
  int increments = 1;                ///< the last stage comes to rest at lambda = 1/n, 2/n, ..., 1
  std::vector<std::string> monitor;  ///< groups or selections whose motion is reported at every rest
};

/// `kind: tuning`
struct TuningStepOptions {
  reflector::TuningOptions tuning;
};

/// `kind: modal`
struct ModalOptions {
  int modes = 6;
  assembly::MassKind mass = assembly::MassKind::consistent;
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
};

using AnyStep = std::variant<FormFindingOptions, MeshOptions, EquilibriumOptions, TuningStepOptions,
                             ModalOptions, RodShapingOptions>;

struct Step {
  std::string kind;  ///< as written in the deck
  std::string name;  ///< given, or kind with a number where a kind repeats; unique
  SourceLocation where;
  AnyStep options;
};

}  // namespace tautline::steps
