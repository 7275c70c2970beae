#include <tautline/model/subdivide.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::model {

namespace {

using Edge = std::pair<int, int>;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

/// @brief Resultants of a facet, given in its frame `from`, for a part of it with the frame `to`.
///
/// They keep their angle to axis 1 of the group, the projection of `orientation` on either; where there is
/// none, the frame is turned by the smallest rotation that takes one normal to the other.
Vec3 turned(const Vec3& resultants, const Mat3& from, const Mat3& to, const Vec3& orientation) {
  double angle = 0;  // from axis 1 of `to` to where axis 1 of `from` has gone
  if (has_projection(from, orientation) && has_projection(to, orientation)) {
    angle = angle_in(to, orientation) - angle_in(from, orientation);
  } else {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(from.col(2), to.col(2));
    angle = angle_in(to, turn * Vec3(from.col(0)));
  }
  Eigen::Matrix2d tensor;
  tensor << resultants[0], resultants[2], resultants[2], resultants[1];
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Eigen::Matrix2d result = rotation * tensor * rotation.transpose();
  return {result(0, 0), result(1, 1), result(0, 1)};
}

class Subdivider {
 public:
  Subdivider(const Model& structure, const SubdivideOptions& options) : old_(structure), options_(options) {
    check();
    new_ = structure;
    new_.cables.clear();
    new_.beams.clear();
    new_.membranes.clear();
    new_.shells.clear();
  }

  Model run() {
    find_facet_sides();
    check_size();
    split_lines(old_.cables, new_.cables, cable_children_);
    split_lines(old_.beams, new_.beams, beam_children_);
    find_spans();
    split_facets(old_.membranes, new_.membranes, membrane_children_);
    split_facets(old_.shells, new_.shells, shell_children_);
    follow();
    find_directors(new_);
    return std::move(new_);
  }

 private:
  void check() const {
    if (options_.subdivisions < 1)
      throw ModelError(fmt::format("subdivisions must be 1 or more, is {}", options_.subdivisions));
    if (options_.pattern == FacetPattern::mapped && options_.subdivisions % 2 != 0 && !old_.membranes.empty())
      throw ModelError(fmt::format("the mapped pattern needs an even number of subdivisions, not {}",
                                   options_.subdivisions));
    for (const auto& [name, parts] : options_.group_subdivisions) {
      const int group = old_.find_group(name);
      if (group < 0) throw ModelError(fmt::format("group_subdivisions: no group is called \"{}\"", name));
      if (stays_whole(group)) continue;
      if (const auto kind = old_.groups[group].kind; !is_cable_like(kind) && kind != ElementKind::beam)
        throw ModelError(fmt::format(
            "group_subdivisions: \"{}\" is made of neither cables nor beams; use subdivisions", name));
      if (parts < 1)
        throw ModelError(
            fmt::format("group_subdivisions: \"{}\" needs 1 or more parts, not {}", name, parts));
    }
  }

  void find_facet_sides() {
    const auto add_sides = [&](const auto& facets) {
      for (const auto& facet : facets)
        for (int k = 0, n = facet.nodes.size(); k < n; ++k)
          sides_[edge_of(facet.nodes[k], facet.nodes[(k + 1) % n])] =
              stays_whole(facet.group) ? 1 : options_.subdivisions;
    };
    add_sides(old_.membranes);
    add_sides(old_.shells);
  }

  /// Far more elements than any machine solves are a slip, told before memory runs out.
  void check_size() const {
    constexpr double most = 5e7;
    double count = 0;
    const auto add_lines = [&](const auto& lines) {
      for (const auto& line : lines)
        count += parts_of(edge_of(line.nodes[0], line.nodes[1]), old_.groups[line.group]);
    };
    const auto add_facets = [&](const auto& facets) {
      for (const auto& facet : facets)
        count +=
            stays_whole(facet.group) ? 1 : static_cast<double>(options_.subdivisions) * options_.subdivisions;
    };
    add_lines(old_.cables);
    add_lines(old_.beams);
    add_facets(old_.membranes);
    add_facets(old_.shells);
    if (count > most)
      throw ModelError(fmt::format(
          "these subdivisions would make {:.3g} elements; at most {:.0e} are made: ask for fewer parts",
          count, most));
  }

  bool stays_whole(int group) const {
    const auto& names = options_.tubes.groups;
    return std::find(names.begin(), names.end(), old_.groups[group].name) != names.end();
  }

  int parts_of(const Edge& edge, const Group& group) const {
    const auto wanted = options_.group_subdivisions.find(group.name);
    const auto side = sides_.find(edge);
    if (side != sides_.end()) {
      if (wanted != options_.group_subdivisions.end() && wanted->second != side->second)
        throw ModelError(fmt::format("group \"{}\" lies on facet sides and must have their {} parts, not {}",
                                     group.name, side->second, wanted->second));
      return side->second;
    }
    if (wanted != options_.group_subdivisions.end()) return wanted->second;
    return group.kind == ElementKind::beam ? options_.subdivisions : 1;
  }

  /// Whether a cable hangs between its ends and touches nothing else there: one that is longer than its chord
  /// and on no facet. Also any cable where there are but cables: nothing else could be meant to be divided.
  bool hangs(const Cable& cable) const {
    const auto& group = old_.groups[cable.group];
    if (group.kind != ElementKind::cable || options_.group_subdivisions.contains(group.name) ||
        sides_.contains(edge_of(cable.nodes[0], cable.nodes[1])))
      return false;
    const bool alone = sides_.empty() && old_.beams.empty();
    return alone || cable.initial_strain < 0;
  }
  static bool hangs(const Beam&) { return false; }

  /// Nodes along a line, shared with nothing.
  std::vector<int> between(int from, int to) {
    std::vector<int> result{from};
    for (int i = 1; i < options_.subdivisions; ++i) {
      const double t = static_cast<double>(i) / options_.subdivisions;
      result.push_back(add_node((1 - t) * old_.nodes[from] + t * old_.nodes[to]));
    }
    result.push_back(to);
    return result;
  }

  int add_node(const Vec3& position) {
    new_.nodes.push_back(position);
    return static_cast<int>(new_.nodes.size()) - 1;
  }

  /// Nodes along an edge from its first to its second end, both included; made once, shared by all on the
  /// edge.
  std::vector<int> along(int from, int to, int parts) {
    const Edge edge = edge_of(from, to);
    auto& inner = inner_nodes_[{edge, parts}];
    if (inner.empty())
      for (int i = 1; i < parts; ++i) {
        const double t = static_cast<double>(i) / parts;
        inner.push_back(add_node((1 - t) * old_.nodes[edge.first] + t * old_.nodes[edge.second]));
      }
    std::vector<int> result{edge.first};
    result.insert(result.end(), inner.begin(), inner.end());
    result.push_back(edge.second);
    if (from != edge.first) std::reverse(result.begin(), result.end());
    return result;
  }

  /// Nodes of a beam on arms from both ends of a facet side: its parts hang on the side's new nodes by arms
  /// of their own, as a rib on a plate. Empty if it is no such beam.
  std::vector<int> beside_side(int a, int b) {
    const auto leader = [&](int node) {
      for (const auto& link : old_.links)
        if (link.group < 0 && link.follower == node) return link.leader;
      return node;
    };
    const int la = leader(a), lb = leader(b);
    const auto side = sides_.find(edge_of(la, lb));
    if ((la == a && lb == b) || side == sides_.end()) return {};
    const auto on_side = along(la, lb, side->second);
    std::vector<int> nodes{a};
    const auto n = static_cast<int>(on_side.size()) - 1;
    for (int k = 1; k < n; ++k) {
      const double t = double(k) / n;
      nodes.push_back(add_node((1 - t) * old_.nodes[a] + t * old_.nodes[b]));
      new_.links.push_back({on_side[k], nodes.back(), false, {}, -1});
    }
    nodes.push_back(b);
    return nodes;
  }

  template <class Line>
  void split_lines(const std::vector<Line>& from, std::vector<Line>& to,
                   std::vector<std::vector<int>>& children) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      const auto& [a, b] = from[i].nodes;
      auto nodes = hangs(from[i]) ? between(a, b) : beside_side(a, b);
      if (nodes.empty()) nodes = along(a, b, parts_of(edge_of(a, b), old_.groups[from[i].group]));
      children.emplace_back();
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        children.back().push_back(static_cast<int>(to.size()));
        to.push_back(from[i]);
        to.back().nodes = {nodes[k], nodes[k + 1]};
        to.back().parent = static_cast<int>(i);
      }
    }
  }

  /// Places of the parts of each beam along it.
  void find_spans() {
    for (std::size_t i = 0; i < beam_children_.size(); ++i) {
      const auto& whole = old_.beams[i].span;
      const auto n = static_cast<double>(beam_children_[i].size());
      for (std::size_t k = 0; k < beam_children_[i].size(); ++k) {
        const auto at = [&](double part) { return whole[0] + (whole[1] - whole[0]) * part / n; };
        new_.beams[beam_children_[i][k]].span = {at(static_cast<double>(k)), at(static_cast<double>(k + 1))};
      }
    }
  }

  /// Frames of a membrane or shell are built alike.
  static Mat3 frame(const Points& points, const FacetNodes& n) {
    if (n.size() == 3) {
      Mat3 x;
      x << points[n[0]], points[n[1]], points[n[2]];
      return element::membrane_frame<3>(x);
    }
    Mat<3, 4> x;
    x << points[n[0]], points[n[1]], points[n[2]], points[n[3]];
    return element::membrane_frame<4>(x);
  }

  template <class Facet>
  void split_facets(const std::vector<Facet>& from, std::vector<Facet>& to,
                    std::vector<std::vector<int>>& children) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      parts_.clear();
      if (stays_whole(from[i].group))
        parts_.push_back(from[i].nodes);
      else
        split_facet(from[i].nodes);
      children.emplace_back();
      for (const auto& nodes : parts_) {
        Facet part = from[i];
        part.nodes = nodes;
        part.parent = static_cast<int>(i);
        part.prestress = turned(from[i].prestress, frame(old_.nodes, from[i].nodes), frame(new_.nodes, nodes),
                                axis_1(old_.groups[static_cast<std::size_t>(from[i].group)]));
        children.back().push_back(static_cast<int>(to.size()));
        to.push_back(part);
      }
    }
  }

  void add_triangle(const std::array<int, 3>& nodes) { parts_.emplace_back(nodes); }

  void split_facet(const FacetNodes& nodes) {
    if (nodes.size() == 4)
      split_quadrilateral(nodes);
    else if (options_.pattern == FacetPattern::mapped && options_.subdivisions > 1)
      split_mapped(nodes);
    else
      split_structured(nodes);
  }

  /// s x s quadrilaterals, bilinear between the sides.
  void split_quadrilateral(const FacetNodes& corner) {
    const int s = options_.subdivisions;
    const auto bottom = along(corner[0], corner[1], s), top = along(corner[3], corner[2], s);
    const auto left = along(corner[0], corner[3], s), right = along(corner[1], corner[2], s);
    std::vector<std::vector<int>> grid(s + 1, std::vector<int>(s + 1));
    const auto& x = old_.nodes;
    for (int j = 0; j <= s; ++j)
      for (int i = 0; i <= s; ++i) {
        const double a = double(i) / s, b = double(j) / s;
        grid[j][i] = j == 0   ? bottom[i]
                     : j == s ? top[i]
                     : i == 0 ? left[j]
                     : i == s ? right[j]
                              : add_node((1 - b) * ((1 - a) * x[corner[0]] + a * x[corner[1]]) +
                                         b * ((1 - a) * x[corner[3]] + a * x[corner[2]]));
      }
    for (int j = 0; j < s; ++j)
      for (int i = 0; i < s; ++i)
        parts_.emplace_back(grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]);
  }

  /// s x s similar triangles: node (i, j) = A + i/s (B - A) + j/s (C - A).
  void split_structured(const FacetNodes& nodes) {
    const int s = options_.subdivisions, a = nodes[0], b = nodes[1], c = nodes[2];
    const auto ab = along(a, b, s), ac = along(a, c, s), bc = along(b, c, s);
    std::vector<std::vector<int>> grid(s + 1);
    for (int j = 0; j <= s; ++j)
      for (int i = 0; i + j <= s; ++i) {
        if (j == 0)
          grid[j].push_back(ab[i]);
        else if (i == 0)
          grid[j].push_back(ac[j]);
        else if (i + j == s)
          grid[j].push_back(bc[j]);
        else
          grid[j].push_back(add_node(old_.nodes[a] + (old_.nodes[b] - old_.nodes[a]) * (double(i) / s) +
                                     (old_.nodes[c] - old_.nodes[a]) * (double(j) / s)));
      }
    for (int j = 0; j < s; ++j)
      for (int i = 0; i + j < s; ++i) {
        add_triangle({grid[j][i], grid[j][i + 1], grid[j + 1][i]});
        if (i + j + 1 < s) add_triangle({grid[j + 1][i + 1], grid[j + 1][i], grid[j][i + 1]});
      }
  }

  /// Three quadrilateral patches (corner, mid-side, centroid, mid-side), each h x h cells mapped bilinearly.
  void split_mapped(const FacetNodes& nodes) {
    const int h = options_.subdivisions / 2;
    const Vec3 centre = (old_.nodes[nodes[0]] + old_.nodes[nodes[1]] + old_.nodes[nodes[2]]) / 3;
    std::array<std::vector<int>, 3> side, spoke;  // spoke[k]: from the middle of side k to the centroid
    const int centroid = add_node(centre);
    for (int k = 0; k < 3; ++k) {
      side[k] = along(nodes[k], nodes[(k + 1) % 3], 2 * h);
      spoke[k].push_back(side[k][h]);
      const Vec3 middle = new_.nodes[side[k][h]];
      for (int i = 1; i < h; ++i) spoke[k].push_back(add_node(middle + (centre - middle) * (double(i) / h)));
      spoke[k].push_back(centroid);
    }
    for (int k = 0; k < 3; ++k) split_patch(h, side[k], side[(k + 2) % 3], spoke[k], spoke[(k + 2) % 3]);
  }

  /// Patch at a corner: `out` runs along the side that leaves the corner, `in` along the side that arrives at
  /// it.
  void split_patch(int h, const std::vector<int>& out, const std::vector<int>& in,
                   const std::vector<int>& out_spoke, const std::vector<int>& in_spoke) {
    std::vector<std::vector<int>> grid(h + 1, std::vector<int>(h + 1));
    const auto point = [&](int node) { return new_.nodes[node]; };
    for (int j = 0; j <= h; ++j)
      for (int i = 0; i <= h; ++i) {
        if (j == 0)
          grid[j][i] = out[i];
        else if (i == 0)
          grid[j][i] = in[2 * h - j];
        else if (i == h)
          grid[j][i] = out_spoke[j];
        else if (j == h)
          grid[j][i] = in_spoke[i];
        else {
          const double x = double(i) / h, y = double(j) / h;
          grid[j][i] = add_node((1 - x) * (1 - y) * point(out[0]) + x * (1 - y) * point(out[h]) +
                                (1 - x) * y * point(in[h]) + x * y * point(out_spoke[h]));
        }
      }
    for (int j = 0; j < h; ++j)
      for (int i = 0; i < h; ++i)
        split_cell({grid[j][i], grid[j][i + 1], grid[j + 1][i + 1], grid[j + 1][i]});
  }

  /// Two triangles of a quadrilateral, divided along its shorter diagonal.
  void split_cell(const std::array<int, 4>& q) {
    const double first = (new_.nodes[q[2]] - new_.nodes[q[0]]).norm();
    const double second = (new_.nodes[q[3]] - new_.nodes[q[1]]).norm();
    if (first <= second) {
      add_triangle({q[0], q[1], q[2]});
      add_triangle({q[0], q[2], q[3]});
    } else {
      add_triangle({q[0], q[1], q[3]});
      add_triangle({q[1], q[2], q[3]});
    }
  }

  /// Selections and supports follow their elements.
  void follow() {
    const auto children = [](std::vector<int>& indices, const std::vector<std::vector<int>>& of) {
      std::vector<int> result;
      for (const int i : indices) result.insert(result.end(), of[i].begin(), of[i].end());
      indices = std::move(result);
    };
    for (auto& [name, selection] : new_.selections) {
      children(selection.cables, cable_children_);
      children(selection.beams, beam_children_);
      children(selection.membranes, membrane_children_);
      children(selection.shells, shell_children_);
      split_edges(selection);
    }
    for (auto& support : new_.supports) {
      auto& nodes = support.nodes;
      const auto found = new_.nodes_of(support.on);
      nodes.insert(nodes.end(), found.begin(), found.end());
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
  }

  /// Edges that are sides of facets, or lie along lines, are divided with them; their new nodes are selected.
  void split_edges(Selection& selection) {
    std::vector<std::array<int, 2>> parts;
    for (const auto& [a, b] : selection.edges) {
      const auto inner = std::find_if(inner_nodes_.begin(), inner_nodes_.end(), [&](const auto& entry) {
        return entry.first.first == edge_of(a, b) && !entry.second.empty();
      });
      const auto nodes =
          inner == inner_nodes_.end() ? std::vector<int>{a, b} : along(a, b, inner->first.second);
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) parts.push_back({nodes[k], nodes[k + 1]});
      selection.nodes.insert(selection.nodes.end(), nodes.begin(), nodes.end());
    }
    selection.edges = std::move(parts);
  }

  const Model& old_;
  const SubdivideOptions& options_;
  Model new_;
  std::map<Edge, int> sides_;
  std::map<std::pair<Edge, int>, std::vector<int>> inner_nodes_;
  std::vector<std::vector<int>> cable_children_, beam_children_, membrane_children_, shell_children_;
  std::vector<FacetNodes> parts_;  // of the facet being split
};

/// Initial motion of the nodes along beams: the cubic through both ends that leaves them as they have turned.
void bend_beams(const Model& structure, Model& mesh) {
  const auto& start = structure.initial;
  for (const auto& beam : mesh.beams) {
    const auto& parent = structure.beams[beam.parent];
    const auto [a, b] = parent.nodes;
    const Vec3 axis = structure.nodes[b] - structure.nodes[a];
    const Vec3 from = structure.nodes[a] + start.displacement[a],
               to = structure.nodes[b] + start.displacement[b];
    const Vec3 leave = start.rotation[a] * axis, arrive = start.rotation[b] * axis;
    for (int end = 0; end < 2; ++end) {
      const double t = (beam.span[end] - parent.span[0]) / (parent.span[1] - parent.span[0]);
      if (t < 1e-9 || t > 1 - 1e-9) continue;
      const double s = 1 - t;
      const Vec3 at =
          (1 + 2 * t) * s * s * from + t * s * s * leave + t * t * (3 - 2 * t) * to - t * t * s * arrive;
      const Vec3 slope = 6 * t * s * (to - from) + s * (1 - 3 * t) * leave + t * (3 * t - 2) * arrive;
      const Eigen::Quaterniond first(start.rotation[a]), last(start.rotation[b]);
      const Mat3 turned = first.slerp(t, last).toRotationMatrix();
      const int node = beam.nodes[end];
      mesh.initial.displacement[node] = at - mesh.nodes[node];
      mesh.initial.rotation[node] =
          Eigen::Quaterniond::FromTwoVectors(turned * axis, slope).toRotationMatrix() * turned;
    }
  }
}

/// The mesh of the moved structure has the same nodes elsewhere.
void carry_initial_motion(const Model& structure, const SubdivideOptions& options, Model& mesh) {
  Model moved = structure;
  for (std::size_t i = 0; i < moved.nodes.size(); ++i) moved.nodes[i] += structure.initial.displacement[i];
  const Points there = Subdivider(moved, options).run().nodes;
  mesh.initial.displacement.resize(there.size());
  for (std::size_t i = 0; i < there.size(); ++i) mesh.initial.displacement[i] = there[i] - mesh.nodes[i];
  mesh.initial.rotation = structure.initial.rotation;
  mesh.initial.rotation.resize(there.size(), Mat3::Identity());
  bend_beams(structure, mesh);
}

}  // namespace

Model subdivide(const Model& described, const SubdivideOptions& options) {
  const bool tubes = !options.tubes.groups.empty();
  const Model replaced = tubes ? tubes_as_shells(described, options.tubes) : Model();
  const Model& structure = tubes ? replaced : described;
  Model mesh = Subdivider(structure, options).run();
  if (!structure.initial.empty()) carry_initial_motion(structure, options, mesh);
  return mesh;
}

}  // namespace tautline::model
