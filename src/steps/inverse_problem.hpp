#pragma once
/// @file
/// Targets, unknowns and residuals of an inverse problem. Theory: docs/theory/inverse.md

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <tautline/analysis/gauss_newton.hpp>
#include <tautline/steps/step_options.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// How far a node is from where it is wanted, and the direction in which that grows fastest.
struct Miss {
  double value = 0;
  Vec3 gradient = Vec3::Zero();
};

/// One condition on one node.
struct Target {
  int entry = 0;  ///< of the deck's list
  std::string quantity;
  int node = 0;
  double weight = 1;
  std::function<Miss(const Vec3&)> miss;
};

/// One condition on each of the nodes. @throws ModelError located in the deck
std::vector<Target> list_targets(const model::Model& model, const InverseOptions& options);

/// One factor on a quantity of some cables.
struct Unknown {
  std::string name;
  InverseUnknownOptions::Quantity quantity = InverseUnknownOptions::Quantity::unstressed_length;
  std::vector<int> cables;
  double lower = 1e-3, upper = std::numeric_limits<double>::infinity();  ///< of the factor
  double start = 0;  ///< mean of the quantity over whole cables before [m] or [N]
};

/// @throws ModelError located in the deck, for names without cables, cables in two unknowns of one quantity,
/// and bounds that the start does not keep
std::vector<Unknown> list_unknowns(const model::Model& model, const InverseOptions& options);

/// Weighted misses of the targets as functions of the factors; each state is an equilibrium.
class CableProblem : public analysis::InverseProblem {
 public:
  CableProblem(Context& context, const InverseOptions& options);

  /// Equilibrium with the cables as they are. @return whether it was found
  bool begin();
  /// Bounds of the factors.
  analysis::Box box() const;

  bool move_to(const VecX& factors) override;
  void keep() override;
  void restore() override;
  VecX residual() override;
  MatX jacobian() override;

  const std::vector<Target>& targets() const { return targets_; }
  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  Vec3 position(int node) const;
  Miss miss(const Target& target) const { return target.miss(position(target.node)); }
  /// To the present state.
  const analysis::PathSummary& last_path() const { return path_; }
  int newton_iterations() const { return newton_iterations_; }
  double start_length(int cable) const { return start_length_[static_cast<std::size_t>(cable)]; }
  double start_stiffness(int cable) const;  ///< E A [N]

 private:
  bool follow_to(const std::vector<double>& strains, const std::vector<double>& stiffness);

  Context& context_;
  assembly::System& system_;
  std::vector<Target> targets_;
  std::vector<Unknown> unknowns_;
  std::vector<int> nodes_;  // of the targets
  std::vector<double> start_strains_, start_factors_, start_length_;
  model::State kept_state_;
  std::vector<double> kept_strains_, kept_factors_;
  analysis::PathSummary path_;
  int newton_iterations_ = 0;
};

}  // namespace tautline::steps
