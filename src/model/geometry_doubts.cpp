#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/model/doubts.hpp>
#include <tautline/model/names.hpp>

#include "model/detail/box_tree.hpp"
#include "model/detail/doubt_limits.hpp"

namespace tautline::model {

namespace {

using namespace detail;

constexpr std::size_t examples = 3;

std::string facet_name(const Model& model, std::size_t facet) {
  const std::size_t n = model.membranes.size();
  if (facet < n) return element_name(model, "membrane", facet, model.membranes[facet].group);
  return element_name(model, "shell", facet - n, model.shells[facet - n].group);
}

/// Doubts of one code become one, with how many there are and the first of them.
class Finds {
 public:
  void add(const std::string& code, std::string what) {
    auto& [count, first] = found_[code];
    ++count;
    if (first.size() < examples) first.push_back(std::move(what));
  }

  std::vector<Doubt> told() const {
    std::vector<Doubt> doubts;
    for (const auto& [code, find] : found_) {
      std::string text = join(find.first, "; ");
      if (find.count > find.first.size())
        text += fmt::format("; and {} more", find.count - find.first.size());
      doubts.push_back({code, text + advice(code), "model"});
    }
    return doubts;
  }

 private:
  static std::string advice(const std::string& code) {
    if (code == "coincident_nodes")
      return ". Nothing joins them: use one node, or a rigid link, hinge or spring";
    if (code == "crossing_elements")
      return ". They do not feel each other there: divide them at a common node if they are joined";
    if (code == "node_on_element")
      return ". They do not feel each other there: divide the member at the node";
    if (code == "duplicate_elements") return ". Their stiffness and mass count twice";
    return "";
  }

  struct Find {
    std::size_t count = 0;
    std::vector<std::string> first;
  };
  std::map<std::string, Find> found_;
};

/// A member or the side of a facet.
struct Line {
  int a, b;
  double length;
  std::string (*name)(const Model&, std::size_t);  ///< null: the side of a facet
  std::size_t index;
  bool is_member() const { return name != nullptr; }
};

/// Where two lines come nearest: their distance, and how far along each, 0 to 1.
struct Nearest {
  double distance, s, t;
};

Nearest nearest_points(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 w = p - q;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w);
  const double det = uu * vv - uv * uv;
  if (det <= 1e-12 * uu * vv) return {std::numeric_limits<double>::infinity(), 0, 0};  // in parallel
  const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
  return {(w + s * u - t * v).norm(), s, t};
}

class GeometryCheck {
 public:
  explicit GeometryCheck(const Model& model)
      : model_(model),
        cluster_(model.nodes.size()),
        shortest_(model.nodes.size(), std::numeric_limits<double>::infinity()) {
    std::iota(cluster_.begin(), cluster_.end(), 0);
    for (const auto& link : model.links) unite(link.leader, link.follower);
    for (const auto& pair : model.cyclic_pairs) unite(pair.leader, pair.follower);
    for (const auto& spring : model.springs) unite(spring.nodes.front(), spring.nodes.back());
    for (const auto& constraint : model.constraints)
      for (const auto& term : constraint.terms) unite(constraint.terms.front().node, term.node);
    add_lines();
    find_held();
  }

  std::vector<Doubt> run() {
    find_duplicates();
    find_short();
    find_meetings();
    find_turned_facets();
    return finds_.told();
  }

 private:
  int root(int node) {
    while (cluster_[node] != node) node = cluster_[node] = cluster_[cluster_[node]];
    return node;
  }
  void unite(int a, int b) { cluster_[root(a)] = root(b); }
  bool joined(int a, int b) { return root(a) == root(b); }

  void add_line(int a, int b, std::string (*name)(const Model&, std::size_t), std::size_t index) {
    const double length = (model_.nodes[b] - model_.nodes[a]).norm();
    lines_.push_back({a, b, length, name, index});
    sides_.insert({std::min(a, b), std::max(a, b)});
    shortest_[a] = std::min(shortest_[a], length);
    shortest_[b] = std::min(shortest_[b], length);
  }

  /// A catenary is not where its chord is.
  void add_lines() {
    for (std::size_t i = 0; i < model_.cables.size(); ++i)
      if (const auto& cable = model_.cables[i]; model_.groups[cable.group].kind != ElementKind::catenary)
        add_line(cable.nodes[0], cable.nodes[1], cable_name, i);
    for (std::size_t i = 0; i < model_.beams.size(); ++i)
      add_line(model_.beams[i].nodes[0], model_.beams[i].nodes[1], beam_name, i);
    const auto add_sides = [&](const auto& facets) {
      for (const auto& facet : facets)
        for (int k = 0, n = facet.nodes.size(); k < n; ++k) {
          const int a = facet.nodes[k], b = facet.nodes[(k + 1) % n];
          if (!sides_.contains({std::min(a, b), std::max(a, b)})) add_line(a, b, nullptr, 0);
        }
    };
    add_sides(model_.membranes);
    add_sides(model_.shells);
  }

  void find_held() {
    held_.assign(model_.nodes.size(), false);
    for (const auto& support : model_.supports)
      if (support.fixed[0] && support.fixed[1] && support.fixed[2])
        for (const int node : support.nodes) held_[node] = true;
  }

  void find_duplicates() {
    const auto find = [&](const auto& elements, const auto& name_of) {
      std::map<std::vector<int>, std::size_t> first;
      for (std::size_t i = 0; i < elements.size(); ++i) {
        std::vector<int> key(elements[i].nodes.begin(), elements[i].nodes.end());
        std::sort(key.begin(), key.end());
        key.push_back(static_cast<int>(model_.groups[elements[i].group].kind));
        const auto [at, is_new] = first.try_emplace(key, i);
        if (!is_new)
          finds_.add("duplicate_elements",
                     fmt::format("{} has the same nodes as {}", name_of(i), name_of(at->second)));
      }
    };
    const std::size_t n_membranes = model_.membranes.size();
    find(model_.cables, [&](std::size_t i) { return cable_name(model_, i); });
    find(model_.beams, [&](std::size_t i) { return beam_name(model_, i); });
    find(model_.membranes, [&](std::size_t i) { return facet_name(model_, i); });
    find(model_.shells, [&](std::size_t i) { return facet_name(model_, n_membranes + i); });
  }

  /// Against the median of all lengths: long ties to an anchor far away are no reason to doubt the others.
  void find_short() {
    if (lines_.empty()) return;
    std::vector<double> lengths;
    for (const auto& line : lines_) lengths.push_back(line.length);
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    for (const auto& line : lines_)
      if (line.is_member() && line.length < short_member * *middle)
        finds_.add("short_element", fmt::format("{} is {:.2g} m long, half of all members {:.3g} m or more",
                                                line.name(model_, line.index), line.length, *middle));
  }

  /// Lines come first, then nodes.
  void find_meetings() {
    std::vector<Box> boxes;
    for (const auto& line : lines_)
      boxes.push_back(Box::around(model_.nodes[line.a], model_.nodes[line.b], meeting * line.length));
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      const double margin = std::isfinite(shortest_[i]) ? touching * shortest_[i] : 0;
      boxes.push_back(Box::around(model_.nodes[i], model_.nodes[i], margin));
    }
    const int n = static_cast<int>(lines_.size());
    std::vector<std::array<int, 2>> pairs;
    BoxTree(boxes).for_each_pair(10'000'000 + 300 * static_cast<long>(boxes.size()), [&](int i, int j) {
      if (j < n) {
        if (lines_[i].is_member() && lines_[j].is_member() && cross(lines_[i], lines_[j]))
          pairs.push_back({i, j});
      } else if (i < n ? lies_on(j - n, lines_[i]) : coincide(i - n, j - n)) {
        pairs.push_back({i, j});
      }
    });
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [i, j] : pairs) tell(i, j, n);
  }

  void tell(int i, int j, int n) {
    const auto name = [&](int line) { return lines_[line].name(model_, lines_[line].index); };
    if (j < n) {
      finds_.add("crossing_elements", fmt::format("{} and {} cross without a common node", name(i), name(j)));
    } else if (i < n) {
      const std::string line =
          lines_[i].is_member() ? name(i)
                                : fmt::format("the side of a facet from {} to {}",
                                              node_name(model_, lines_[i].a), node_name(model_, lines_[i].b));
      finds_.add("node_on_element",
                 fmt::format("{} lies on {}, to which it does not belong", node_at(model_, j - n), line));
    } else {
      const double distance = (model_.nodes[j - n] - model_.nodes[i - n]).norm();
      finds_.add("coincident_nodes",
                 fmt::format("{} and {} are {}", node_at(model_, i - n), node_name(model_, j - n),
                             distance == 0 ? "at the same place" : fmt::format("{:.2g} m apart", distance)));
    }
  }

  bool share(const Line& one, const Line& other) {
    return joined(one.a, other.a) || joined(one.a, other.b) || joined(one.b, other.a) ||
           joined(one.b, other.b);
  }

  /// Diagonals of one panel pass each other by custom: three of its four sides, or more, are members or lie
  /// between two supports.
  bool brace(const Line& one, const Line& other) {
    const auto side = [&](int a, int b) {
      return (held_[a] && held_[b]) || sides_.contains({std::min(a, b), std::max(a, b)});
    };
    return side(one.a, other.a) + side(one.a, other.b) + side(one.b, other.a) + side(one.b, other.b) >= 3;
  }

  bool cross(const Line& one, const Line& other) {
    if (share(one, other) || brace(one, other)) return false;
    const Vec3 &p = model_.nodes[one.a], &q = model_.nodes[other.a];
    const auto [distance, s, t] = nearest_points(p, model_.nodes[one.b] - p, q, model_.nodes[other.b] - q);
    const double end = touching;
    return distance < meeting * std::min(one.length, other.length) && s > end && s < 1 - end && t > end &&
           t < 1 - end;
  }

  /// Nodes of links that carry nothing else lie where they must.
  bool lies_on(int node, const Line& line) {
    if (!std::isfinite(shortest_[node]) || joined(node, line.a) || joined(node, line.b)) return false;
    if (held_[node] && held_[line.a] && held_[line.b]) return false;
    const Vec3 &p = model_.nodes[line.a], u = model_.nodes[line.b] - p, w = model_.nodes[node] - p;
    const double s = w.dot(u) / u.squaredNorm();
    const double scale = std::min(line.length, shortest_[node]);
    return s > touching && s < 1 - touching && (w - s * u).norm() < meeting * scale;
  }

  bool coincide(int a, int b) {
    if (joined(a, b) || (held_[a] && held_[b])) return false;
    const double scale = std::min(shortest_[a], shortest_[b]);
    if (!std::isfinite(scale)) return false;
    const double distance = (model_.nodes[b] - model_.nodes[a]).norm();
    return distance < touching * scale;
  }

  /// Neighbours under one pressure run along their common side in opposite directions if they face one side.
  void find_turned_facets() {
    std::set<std::string> told;
    for (const auto& load : model_.loads) {
      if (load.pressure == 0 || !told.insert(fmt::format("{}", fmt::join(load.on, "\n"))).second) continue;
      const auto selected = model_.select(load.on);
      std::map<std::array<int, 2>, std::vector<std::pair<std::size_t, bool>>> sides;
      const auto add = [&](const FacetNodes& nodes, std::size_t facet) {
        for (int k = 0, n = nodes.size(); k < n; ++k) {
          const int a = nodes[k], b = nodes[(k + 1) % n];
          sides[{std::min(a, b), std::max(a, b)}].emplace_back(facet, a < b);
        }
      };
      for (const int i : selected.membranes) add(model_.membranes[i].nodes, static_cast<std::size_t>(i));
      for (const int i : selected.shells)
        add(model_.shells[i].nodes, model_.membranes.size() + static_cast<std::size_t>(i));
      for (const auto& [side, facets] : sides)
        if (facets.size() == 2 && facets[0].second == facets[1].second)
          finds_.add(
              "mixed_orientation",
              fmt::format("{} and {} share the side from {} to {} and face opposite sides, so that the "
                          "pressure of load \"{}\" pushes them in opposite directions: reverse the nodes "
                          "of one",
                          facet_name(model_, facets[0].first), facet_name(model_, facets[1].first),
                          node_name(model_, side[0]), node_name(model_, side[1]), load.name));
    }
  }

  const Model& model_;
  std::vector<int> cluster_;
  std::vector<double> shortest_;  // member or side at each node
  std::vector<bool> held_;
  std::vector<Line> lines_;
  std::set<std::array<int, 2>> sides_;  // whose ends a member or the side of a facet joins
  Finds finds_;
};

}  // namespace

std::vector<Doubt> geometry_doubts(const Model& model) {
  return GeometryCheck(model).run();
}

}  // namespace tautline::model
