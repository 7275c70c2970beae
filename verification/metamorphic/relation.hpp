#pragma once
/// @file
/// A relation between runs whose effect is known without knowing the answer.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"
#include "outcome.hpp"
#include "random.hpp"

namespace tautline::metamorphic {

using Outcomes = std::vector<Outcome>;

/// What a relation does with one structure.
struct Trial {
  std::vector<Job> jobs;
  /// Jobs that need what came of the first ones.
  std::function<std::vector<Job>(const Outcomes&)> then = nullptr;
  /// Differences over what is allowed, the largest first; called when every job is done.
  std::function<std::vector<Difference>(const Outcomes&)> judge;
  /// Jobs may end differently, and `judge` is called whatever came.
  bool any_end = false;
};

struct Relation {
  std::string name;
  std::string says;   ///< the relation in a sentence
  std::string bound;  ///< how far numbers may differ, and why
  std::function<Json(Random&)> make;
  /// The trial of a structure, which may have been made smaller since; no value: it does not apply.
  std::function<std::optional<Trial>(const Json&, Random&)> derive;
};

/// All relations, in the order of the README.
const std::vector<Relation>& relations();

// Groups of them, each in a file of its own.
std::vector<Relation> relations_of_description();  ///< the same structure, told otherwise
std::vector<Relation> relations_of_elements();     ///< one kind of element or state for another
std::vector<Relation> relations_of_loads();        ///< loads that are the same, reactions, superposition
std::vector<Relation> relations_of_symmetry();     ///< halves and sectors
std::vector<Relation> relations_of_runs();         ///< steps, checkpoints, ranks, check
std::vector<Relation> relations_of_analyses();     ///< one analysis against another

/// A job after another, compared number by number: the second must be what `expected` makes of the first.
Trial pair(Json first, Json second, std::function<Outcome(const Outcome&)> expected, double tolerance);

/// What is expected where nothing changes.
Outcome unchanged(const Outcome& outcome);

/// 1e-6 of the largest number of a unit: Newton's method stops at 1e-9 of the forces, and the softest
/// motions of the structures made here are a thousand times softer than the stiffest.
constexpr double usual_tolerance = 1e-6;

}  // namespace tautline::metamorphic
