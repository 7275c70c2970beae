#include "steps/rear_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

#include "steps/balanced_form.hpp"
#include "steps/reflector_form.hpp"

namespace tautline::steps {

namespace {

constexpr int most_rounds = 1000;
constexpr int fitting_rounds = 4;  // in which a balanced rear net gets new force densities
constexpr double at_rest = 1e-12;  // change of the ties' pull over the largest

/// Ties as nodes of both nets.
class Ties {
 public:
  Ties(const model::Model& structure, const FormNet& front, const FormNet& rear) {
    std::vector<int> sharing(structure.nodes.size(), 0);
    for (const int i : structure.select("ties").cables) ++sharing[structure.cables[i].nodes[0]];
    for (const int i : structure.select("ties").cables) {
      const auto [a, b] = structure.cables[i].nodes;
      ends_.push_back({front.local[a], rear.local[b]});
      share_.push_back(1.0 / sharing[a]);
      if (ends_.back()[1] < 0)
        throw ModelError(
            fmt::format("form-finding: no cord of the rear net meets the tie at ({:.3f}, {:.3f})",
                        structure.nodes[a].x(), structure.nodes[a].y()));
    }
    tension_ = VecX::Zero(static_cast<Eigen::Index>(ends_.size()));
  }

  /// Tensions from what the front nodes need along z, pulls from where the ends are.
  /// @return largest change of a pull over the largest pull
  double update(FormNet& front, const Form& found, FormNet& rear);
  const VecX& tension() const { return tension_; }
  double largest_inclination() const { return inclination_; }

 private:
  std::vector<std::array<int, 2>> ends_;
  std::vector<double> share_;
  VecX tension_;
  double inclination_ = 0;  ///< to the vertical [rad]
};

double Ties::update(FormNet& front, const Form& found, FormNet& rear) {
  const Points before = rear.net.load;
  front.net.load.assign(front.nodes.size(), Vec3::Zero());
  rear.net.load.assign(rear.nodes.size(), Vec3::Zero());
  inclination_ = 0;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const auto [a, b] = ends_[i];
    const Vec3& at = found.nodes[a];
    const Vec3 along = (rear.net.nodes[b] - at).normalized();
    if (!(along.z() < 0))
      throw ModelError(
          fmt::format("form-finding: front and rear net touch at ({:.3f}, {:.3f}); tighter rear cords lie "
                      "further from the front net, as does a larger surface_height",
                      at.x(), at.y()));
    const double tension = found.reaction[a].z() * share_[i] / along.z();
    if (!(tension > 0))
      throw ModelError(
          fmt::format("form-finding: the tie at ({:.3f}, {:.3f}) would be pressed with {:.3g} N; a tie only "
                      "pulls: check the front net's tensions",
                      at.x(), at.y(), -tension));
    tension_[static_cast<Eigen::Index>(i)] = tension;
    inclination_ = std::max(inclination_, std::acos(std::min(1.0, -along.z())));
    front.net.load[a] += Vec3(tension * along.x(), tension * along.y(), 0);
    rear.net.load[b] -= tension * along;
  }
  double change = 0, largest = 0;
  for (std::size_t i = 0; i < rear.net.load.size(); ++i) {
    largest = std::max(largest, rear.net.load[i].norm());
    if (!before.empty()) change = std::max(change, (rear.net.load[i] - before[i]).norm());
  }
  return before.empty() ? std::numeric_limits<double>::infinity() : change / largest;
}

/// What is asked of the rear net: tensions of the groups that state one, the other groups keep their force
/// densities; or nothing but balance.
FormFindingOptions options_of_rear(const Context& context, const FormFindingOptions& options) {
  FormFindingOptions rear;
  rear.cloth = std::vector<std::string>{};
  rear.net = rear_net_groups(context.structure);
  rear.method = FormMethod::balanced;
  if (rear_form(context, options) == RearForm::balanced) return rear;
  rear.method = FormMethod::constraints;
  for (const auto& name : rear.net) {
    const auto& group = context.deck.groups.at(name);
    if (!group.tension) {
      rear.hold.push_back(name);
      continue;
    }
    auto& demand = rear.constraints.emplace_back();
    demand.kind = formfinding::ConstraintKind::tension;
    demand.on = {name};
    demand.value = {*group.tension};
  }
  return rear;
}

/// Force densities to start from: tension wanted over the length where the nodes are.
VecX start_of_rear(const Context& context, const FormNet& rear) {
  formfinding::BalancedOptions as_wished;
  as_wished.balance_weight = 0;
  as_wished.rounds = 1;
  return balancing(context, rear, as_wished);
}

bool patterns_differ(const Context& context) {
  const auto* umbrella = context.deck.umbrella();
  return umbrella != nullptr &&
         umbrella->rear_pattern.value_or(umbrella->front_pattern) != umbrella->front_pattern;
}

/// Free nodes of the rear net begin as images of the front net's.
void mirror(const Context& context, const FormNet& front, FormNet& rear) {
  for (const int i : context.structure.select("ties").cables) {
    const auto [a, b] = context.structure.cables[i].nodes;
    const Vec3& at = front.net.nodes[front.local[a]];
    rear.net.nodes[rear.local[b]] = Vec3(at.x(), at.y(), -at.z() - context.deck.dish()->gap);
  }
}

/// Puts the free nodes of the rear net, where they are drawn, on the image of the surface.
void lay_on_image(const Context& context, FormNet& rear) {
  for (std::size_t i = 0; i < rear.nodes.size(); ++i) {
    Vec3& at = rear.net.nodes[i];
    if (!rear.net.fixed[i]) at.z() = -context.surface->height(at.x(), at.y()) - context.deck.dish()->gap;
  }
}

/// Rear nodes stay below the front nodes, so that ties come out steep; heights follow from the tensions.
formfinding::BalancedOptions plan_of_rear() {
  formfinding::BalancedOptions options;
  options.balance_weight = 10;
  options.height_weight = 0;
  options.rounds = 1;
  return options;
}

/// How even a net's tensions are, for the report.
Json spread(const VecX& tension) {
  return {{"min", tension.minCoeff()},
          {"max", tension.maxCoeff()},
          {"ratio", tension.maxCoeff() / tension.minCoeff()}};
}

}  // namespace

RearForm rear_form(const Context& context, const FormFindingOptions& options) {
  if (options.rear) return *options.rear;
  return patterns_differ(context) ? RearForm::balanced : RearForm::mirrored;
}

CoupledForm find_coupled(const Context& context, const FormFindingOptions& options, FormNet& front) {
  const auto rear_options = options_of_rear(context, options);
  CoupledForm result;
  result.rear_net = extract_net(context, rear_options);
  auto& rear = result.rear_net;
  rear.surface = nullptr;
  Ties ties(context.structure, front, rear);
  const bool balanced = rear_options.method == FormMethod::balanced;
  Json changes = Json::array();
  double change = 1;
  for (int round = 0; round < most_rounds && change > at_rest; ++round) {
    result.front = find_form(context, options, front);
    if (!result.front.converged) return result;
    front.net.nodes = result.front.nodes;
    if (round == 0 && patterns_differ(context)) lay_on_image(context, rear);
    if (round == 0 && !patterns_differ(context)) mirror(context, front, rear);
    change = ties.update(front, result.front, rear);
    if (round > 0) changes.push_back(change);
    if (!balanced) rear.force_density = start_of_rear(context, rear);
    if (balanced && round < fitting_rounds) rear.force_density = balancing(context, rear, plan_of_rear());
    result.rear = find_form(context, rear_options, rear);
    if (!result.rear.converged) {
      result.front.converged = false;
      result.front.reason = "rear net: " + result.rear.reason;
      return result;
    }
    rear.net.nodes = result.rear.nodes;
  }
  if (change > at_rest) {
    result.front.converged = false;
    result.front.reason = fmt::format(
        "the ties still change their pull by {:.3g} > {:.3g} of the largest after {} rounds, the "
        "most inclined by {:.3g} degrees; a tighter rear net or a larger surface_height makes them "
        "steeper",
        change, at_rest, most_rounds, ties.largest_inclination() * 180 / std::numbers::pi);
  }
  result.tie_tension = ties.tension();
  result.details = {{"method", balanced ? "balanced" : "tension"},
                    {"rounds", changes.size() + 1},
                    {"last_change", change},
                    {"out_of_balance", result.rear.details["out_of_balance"]},
                    {"largest_tie_inclination", ties.largest_inclination() * 180 / std::numbers::pi},
                    {"tension", spread(result.rear.tension)}};
  return result;
}

void take_rear(Context& context, const CoupledForm& found) {
  auto& structure = context.structure;
  const auto& rear = found.rear_net;
  for (std::size_t i = 0; i < rear.nodes.size(); ++i) structure.nodes[rear.nodes[i]] = found.rear.nodes[i];
  for (std::size_t b = 0; b < rear.cables.size(); ++b)
    structure.cables[rear.cables[b]].initial_strain =
        found.rear.tension[static_cast<Eigen::Index>(b)] / rear.stiffness(structure, b);
  const auto ties = structure.select("ties").cables;
  for (std::size_t i = 0; i < ties.size(); ++i)
    structure.cables[ties[i]].initial_strain = found.tie_tension[static_cast<Eigen::Index>(i)] /
                                               structure.axial_stiffness(structure.cables[ties[i]]);
}

}  // namespace tautline::steps
