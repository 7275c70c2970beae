#include "model/detail/load_faults.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <fmt/format.h>

#include <tautline/model/names.hpp>

namespace tautline::model::detail {

namespace {

using Edge = std::array<int, 2>;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Sides of facets, and lines; of beams that hang on nodes the line between these.
std::set<Edge> sides_of(const Model& model) {
  std::set<Edge> sides;
  std::map<int, int> leader;
  for (const auto& link : model.links)
    if (link.group < 0) leader[link.follower] = link.leader;
  const auto node_of = [&](int end) {
    const auto found = leader.find(end);
    return found == leader.end() ? end : found->second;
  };
  const auto add_lines = [&](const auto& lines) {
    for (const auto& line : lines) {
      sides.insert(edge_of(line.nodes[0], line.nodes[1]));
      sides.insert(edge_of(node_of(line.nodes[0]), node_of(line.nodes[1])));
    }
  };
  const auto add_facets = [&](const auto& facets) {
    for (const auto& facet : facets)
      for (int k = 0, n = facet.nodes.size(); k < n; ++k)
        sides.insert(edge_of(facet.nodes[k], facet.nodes[(k + 1) % n]));
  };
  add_lines(model.cables);
  add_lines(model.beams);
  add_facets(model.membranes);
  add_facets(model.shells);
  return sides;
}

class LoadCheck {
 public:
  explicit LoadCheck(const Model& model) : model_(model), turns_(model.rotational_nodes()) {}

  std::vector<std::string> run() {
    for (const auto& load : model_.loads) {
      check_nodal(load);
      check_elements(load);
      if (!load.acceleration.isZero(0) && total_mass(model_) == 0)
        fault(load, "acceleration acts on mass, and nothing has any: give a section or material its density");
    }
    return std::move(faults_);
  }

 private:
  void fault(const Load& load, const std::string& what) {
    faults_.push_back(fmt::format("{}: {}", load.title(), what));
  }

  std::string place(int node) const { return node_at(model_, node); }

  void check_nodal(const Load& load) {
    const bool acts = !load.force.isZero(0) || !load.moment.isZero(0) || load.moves();
    if (acts && load.nodes.empty())
      return fault(load, "it acts on nodes, and what is named in \"on\" has none");
    if (!load.moment.isZero(0)) need_rotations(load, "a moment", load.nodes);
  }

  void need_rotations(const Load& load, const char* what, const std::vector<int>& nodes) {
    std::vector<int> without;
    for (const int node : nodes)
      if (!turns_[node]) without.push_back(node);
    if (without.empty()) return;
    const std::string others =
        without.size() == 1 ? "" : fmt::format(" (and {} other nodes)", without.size() - 1);
    fault(load,
          fmt::format("nothing at {}{} takes up {}: cables, membranes and beams whose ends are released "
                      "leave its rotation free. Load a node to which a beam or shell is fixed",
                      place(without.front()), others, what));
  }

  void check_elements(const Load& load) {
    const auto selected = model_.select(load.on);
    const bool facets = !selected.membranes.empty() || !selected.shells.empty();
    const bool lines = !selected.beams.empty() || !selected.edges.empty();
    const bool line_force = !load.line_force.isZero(0), line_moment = !load.line_moment.isZero(0);
    if (!load.surface_force.isZero(0) && !facets) fault(load, "surface_force acts on no membrane or shell");
    if (load.pressure != 0 && !facets) fault(load, "pressure acts on no membrane or shell");
    if (line_force && !lines && selected.cables.empty())
      fault(load, "line_force acts on no beam, cable, bar or edge");
    if (line_force || line_moment) check_edges(load, selected.edges);
    if (load.heats() && selected.cables.empty() && selected.beams.empty() && !facets)
      fault(load, "a temperature acts on no element");
    if (!line_moment) return;
    if (!lines) fault(load, "line_moment acts on no beam or edge");
    if (!selected.cables.empty())
      fault(load, "line_moment is for beams and edges; cables and bars take none");
    std::vector<int> ends;
    for (const auto& edge : selected.edges) ends.insert(ends.end(), edge.begin(), edge.end());
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    need_rotations(load, "a line_moment", ends);
  }

  void check_edges(const Load& load, const std::vector<Edge>& edges) {
    if (edges.empty()) return;
    if (sides_.empty()) sides_ = sides_of(model_);
    for (const auto& [a, b] : edges)
      if (!sides_.contains(edge_of(a, b)))
        return fault(load,
                     fmt::format("the edge from {} to {} is no side of a membrane or shell, nor is there a "
                                 "beam or cable along it",
                                 place(a), place(b)));
  }

  const Model& model_;
  std::vector<bool> turns_;
  std::set<Edge> sides_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> load_faults(const Model& model) {
  return model.loads.empty() ? std::vector<std::string>() : LoadCheck(model).run();
}

}  // namespace tautline::model::detail
