#pragma once
/// @file
/// Linear buckling of the present state, for the steps that need it. Theory: docs/theory/buckling.md

#include <map>
#include <string>
#include <vector>

#include <tautline/la/eigen_solver.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Load factors nearest to zero, their modes and residuals; or why there are none.
struct LinearBuckling {
  std::vector<double> factors, residuals;
  std::vector<la::Vector> modes;
  std::string failure;  ///< empty if it worked
  /// By sign of the factors and group: cables that are slack at the first factor.
  std::map<std::string, std::map<std::string, int>> slack;
  struct Doubt {
    std::string code, message;
  };
  std::vector<Doubt> doubts;  ///< where the factors are not to be trusted
};

/// Names of loads that are scaled: those given, or all of the deck that do not act yet, except `but`.
std::vector<std::string> scaled_loads(const Context& context,
                                      const std::optional<std::vector<std::string>>& given,
                                      const std::vector<std::string>& but = {});

/// What is held and acts at present, with the loads named added once more, `factor` times.
assembly::Boundary boundary_with(Context& context, const std::vector<std::string>& loads, double factor = 1);

/// Sum over the nodes of the sizes of the forces named, or of the moments if there are no forces [N], [N m].
double reference_load(Context& context, const std::vector<std::string>& loads);

/// @throws ModelError for a structure in which nothing carries compression
void require_compression(const model::Model& model);

/// Brings the system to rest under what acts at present. @return why it failed, or nothing
std::string come_to_rest(Context& context);

/// @brief Factors nearest to zero on the loads named, beside what acts at present, at which the tangent,
/// linear in the factor, is singular. The system must be at rest and stays where it is.
///
/// Cables that only pull go slack and taut on the way; so do membranes that wrinkle where the way begins.
/// Factors behind the first are those of the cables that are taut at the first.
LinearBuckling linear_buckling(Context& context, const std::vector<std::string>& loads, int modes,
                               BucklingOptions::Sign sign);

}  // namespace tautline::steps
