#include <tautline/assembly/slack.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/model/names.hpp>
#include <tautline/model/response.hpp>

namespace tautline::assembly {

namespace {

/// Elements that resist nothing, or not in every direction, and the nodes where there are only such.
class Loose {
 public:
  explicit Loose(const System& system)
      : system_(system),
        model_(system.model()),
        slack_(model_.nodes.size(), false),
        firm_(model_.nodes.size(), false) {
    const auto& state = system.state();
    const auto response = model::evaluate_response(model_, state);
    for (const auto& cable : model_.cables) mark(cable.nodes, model::is_slack(model_, state, cable));
    for (std::size_t i = 0; i < model_.membranes.size(); ++i)
      mark(model_.membranes[i].nodes, response.membranes[i].state != element::MembraneState::taut);
    const auto mark_firm = [&](const auto& elements) {
      for (const auto& element : elements) mark(element.nodes, false);
    };
    mark_firm(model_.beams);
    mark_firm(model_.shells);
    mark_firm(model_.springs);
  }

  std::vector<int> nodes() const {
    std::vector<int> result;
    for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node)
      if (is_loose(node)) result.push_back(node);
    return result;
  }

 private:
  template <class Nodes>
  void mark(const Nodes& nodes, bool slack) {
    for (const int node : nodes) (slack ? slack_ : firm_)[static_cast<std::size_t>(node)] = true;
  }
  bool is_loose(int node) const {
    const auto at = static_cast<std::size_t>(node);
    const int block = system_.dof_map().displacement_block[at];
    return slack_[at] && !firm_[at] && block >= 0 && system_.kinematics().plain(node);
  }

  const System& system_;
  const model::Model& model_;
  std::vector<bool> slack_, firm_;
};

/// Vector of this rank's part of values by unknown.
la::Vector own_part(const System& system, const std::vector<double>& all) {
  const auto& layout = system.layout();
  la::Vector v(layout);
  v.write(std::span(all).subspan(static_cast<std::size_t>(3 * layout.first),
                                 static_cast<std::size_t>(3 * layout.local)));
  return v;
}

/// `value(node)` in the unknowns of these nodes, zero where held and elsewhere.
template <class Value>
la::Vector on_nodes(const System& system, const std::vector<int>& nodes, const Value& value) {
  std::vector<double> all(static_cast<std::size_t>(system.n_dofs()), 0.0);
  for (const int node : nodes) {
    const int block = system.dof_map().displacement_block[static_cast<std::size_t>(node)];
    const Vec3 v = value(node, block);
    for (int c = 0; c < 3; ++c)
      if (const auto at = static_cast<std::size_t>(3 * block + c); !system.held()[at]) all[at] = v[c];
  }
  return own_part(system, all);
}

/// The tangent with some stiffness put to the slack nodes.
class Stiffened {
 public:
  Stiffened(System& system, analysis::Workspace& workspace, const std::vector<int>& nodes)
      : system_(system), workspace_(workspace), scale_(system.layout()) {
    system.tangent(workspace.tangent);
    std::vector<double> all;
    la::Vector sums(system.layout()), taut(system.layout());
    sums.write(workspace.tangent.absolute_row_sums_of_blocks());
    system.taut_stiffness(taut);
    sums.add(1, taut);
    sums.gather(all);
    scale_ = on_nodes(system, nodes, [&](int, int block) -> Vec3 {
      return Eigen::Map<const Vec3>(&all[static_cast<std::size_t>(3 * block)]);
    });
  }
  /// @return whether every motion meets resistance now
  bool factor(double part) {
    system_.tangent(workspace_.tangent);
    workspace_.tangent.add_diagonal(part, scale_);
    return workspace_.solver.factor(workspace_.tangent) && workspace_.solver.inertia().null == 0;
  }
  /// What is added at full part, by unknown.
  std::vector<double> scale() const {
    std::vector<double> all;
    scale_.gather(all);
    return all;
  }
  /// Force that the added stiffness takes when `load` acts.
  la::Vector taken(const la::Vector& load, double part) {
    la::Vector y = la::Vector::like(load);
    workspace_.solver.solve(load, y);
    y.multiply_entries(scale_);
    y.scale(part);
    return y;
  }

 private:
  System& system_;
  analysis::Workspace& workspace_;
  la::Vector scale_;
};

constexpr double some = 1e-8, less = 1e-11;  // of a node's stiffness when taut

/// Dead forces that act on the nodes.
la::Vector acting_on(const System& system, const std::vector<int>& nodes) {
  const auto acting = system.applied().force;
  return on_nodes(system, nodes, [&](int node, int block) -> Vec3 {
    return system.kinematics().frame(block).transpose() * acting[static_cast<std::size_t>(node)];
  });
}

/// Whether a load has a part in a motion without resistance: then the added stiffness takes the same force,
/// however little it is; else a force in proportion to it.
bool load_feels(const System& system, Stiffened& stiffened, const la::Vector& load) {
  const double level = 10 * system.rounding().force;
  if (load.norm() <= level) return false;
  stiffened.factor(some);
  const double first = stiffened.taken(load, some).norm();
  stiffened.factor(less);
  const double second = stiffened.taken(load, less).norm();
  return second > level && second > first / 10;
}

/// Those of the nodes that move in motions without resistance: there the added stiffness takes a load whole.
std::vector<int> moving(System& system, Stiffened& stiffened, const std::vector<int>& nodes) {
  constexpr double share = 0.1;
  std::vector<double> rest;
  const la::Vector odd = on_nodes(system, nodes, [](int node, int) -> Vec3 {
    return {1 + 0.5 * std::sin(1.7 * node), 1 + 0.5 * std::sin(2.3 * node + 1),
            1 + 0.5 * std::sin(2.9 * node + 2)};
  });
  stiffened.factor(less);
  stiffened.taken(odd, less).gather(rest);
  std::vector<int> result;
  for (const int node : nodes) {
    const int block = system.dof_map().displacement_block[static_cast<std::size_t>(node)];
    if (Eigen::Map<const Vec3>(&rest[static_cast<std::size_t>(3 * block)]).norm() > share)
      result.push_back(node);
  }
  return result;
}

/// Indices of the elements that meet at one of the sorted nodes.
template <class Elements>
std::vector<int> elements_at(const std::vector<int>& nodes, const Elements& elements) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(elements.size()); ++i) {
    const auto& own = elements[static_cast<std::size_t>(i)].nodes;
    if (std::any_of(own.begin(), own.end(),
                    [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); }))
      result.push_back(i);
  }
  return result;
}

std::string count(std::size_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

/// "6 facets of film, 2 cables of ridge"
template <class Elements>
void tell(const model::Model& model, const Elements& elements, const std::vector<int>& indices,
          const std::string& what, std::vector<std::string>& parts) {
  std::map<int, std::size_t> by_group;
  for (const int i : indices) ++by_group[elements[static_cast<std::size_t>(i)].group];
  for (const auto& [group, n] : by_group)
    parts.push_back(
        fmt::format("{} of {}", count(n, what), model.groups[static_cast<std::size_t>(group)].name));
}

std::string sentence(const System& system, const Slack& slack) {
  constexpr std::size_t most = 4;
  const auto& model = system.model();
  std::vector<std::string> parts, places;
  tell(model, model.membranes, slack.membranes, "facet", parts);
  tell(model, model.cables, slack.cables, "cable", parts);
  for (const int node : slack.nodes) {
    if (places.size() == most) break;
    places.push_back(model::node_at(model, node));
  }
  return fmt::format(
      "slack: {}, about {}{}, as drawn. Nothing loads {} and nothing resists: where {} undetermined",
      join(parts, ", ", parts.size()), join(places, ", ", places.size()),
      slack.nodes.size() > most ? fmt::format(" and {} more", slack.nodes.size() - most) : "",
      slack.nodes.size() == 1 ? "it" : "them", slack.nodes.size() == 1 ? "it is, is" : "they are, is");
}

}  // namespace

std::optional<Slack> find_slack(System& system, analysis::Workspace& workspace) {
  const auto loose = Loose(system).nodes();
  if (loose.empty()) return std::nullopt;
  Stiffened stiffened(system, workspace, loose);
  Slack slack;
  const bool only_slack = stiffened.factor(some),
             matters = !only_slack || load_feels(system, stiffened, acting_on(system, loose));
  if (!matters) slack.nodes = moving(system, stiffened, loose);
  system.tangent(workspace.tangent);
  workspace.solver.factor(workspace.tangent);
  if (matters) return std::nullopt;
  slack.cables = elements_at(slack.nodes, system.model().cables);
  slack.membranes = elements_at(slack.nodes, system.model().membranes);
  if (!slack.nodes.empty()) slack.text = sentence(system, slack);
  return slack;
}

Bracing::Bracing(System& system, analysis::Workspace& workspace) : system_(system) {
  const auto slack = find_slack(system, workspace);
  if (!slack) return;
  Stiffened stiffened(system, workspace, slack->nodes);
  la::Vector growing(system.layout());
  system.load_rate(growing);
  holds_ = stiffened.factor(some) && !load_feels(system, stiffened, growing);
  if (!holds_) return;
  auto stiffness = stiffened.scale();
  for (double& k : stiffness) k *= some;
  system.brace(std::move(stiffness));
}

Bracing::~Bracing() {
  system_.brace({});
}

}  // namespace tautline::assembly
