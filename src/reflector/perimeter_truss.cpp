#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <tautline/core/error.hpp>
#include <tautline/reflector/perimeter_truss.hpp>
#include <utility>

namespace tautline::reflector {

namespace {

constexpr int fewest_struts = 3;

/// The triangular net: centre, ring k of 6k nodes from +x counter-clockwise.
class HexagonalLattice {
 public:
  explicit HexagonalLattice(int rings) : rings_(rings) {}

  int rings() const { return rings_; }
  int n_nodes() const { return first(rings_ + 1); }
  /// Nodes inside the rim; they come first.
  int n_free() const { return first(rings_); }
  int n_rim() const { return 6 * rings_; }
  /// Node `j` (counted round and round) of ring `k`.
  int node(int k, int j) const { return k == 0 ? 0 : first(k) + j % (6 * k); }
  int rim(int j) const { return node(rings_, j); }

  /// Triangles, counter-clockwise seen from +z.
  std::vector<std::array<int, 3>> facets() const;
  /// Sides of the triangles, lower node first, except those between neighbours on the rim.
  std::vector<std::array<int, 2>> sides() const;

 private:
  static int first(int k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); }
  int rings_;
};

std::vector<std::array<int, 3>> HexagonalLattice::facets() const {
  std::vector<std::array<int, 3>> facets;
  for (int k = 0; k < rings_; ++k) {
    for (int sector = 0; sector < 6; ++sector) {
      // The t-th node of ring k lies between the t-th and the (t + 1)-th of ring k + 1.
      for (int t = 0; t <= k; ++t) {
        const int inner = node(k, sector * k + t);
        const int outer = sector * (k + 1) + t;
        facets.push_back({inner, node(k + 1, outer), node(k + 1, outer + 1)});
        if (t < k) facets.push_back({inner, node(k + 1, outer + 1), node(k, sector * k + t + 1)});
      }
    }
  }
  return facets;
}

std::vector<std::array<int, 2>> HexagonalLattice::sides() const {
  std::set<std::array<int, 2>> sides;
  for (const auto& facet : facets()) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(facet[i], facet[(i + 1) % 3]);
      if (low < n_free()) sides.insert({low, high});
    }
  }
  return {sides.begin(), sides.end()};
}

/// Adds the parts of the reflector to a model, one group after the other.
class Builder {
 public:
  Builder(const PerimeterTrussOptions& options, int struts)
      : options_(options), surface_(make_paraboloid(options)), lattice_(options.rings), n_struts_(struts) {}

  model::Model build();

 private:
  int rear(int front_node) const { return front_node + lattice_.n_nodes(); }
  int strut_rim_node(int strut) const { return lattice_.rim(strut * (lattice_.n_rim() / n_struts_)); }
  int add_group(const std::string& name, model::ElementKind kind);
  void add_nodes();
  void check_apart() const;
  void add_nets_and_ties();
  void add_frame();
  void add_diagonals();
  void add_cloth();
  void add_selections();

  const PerimeterTrussOptions& options_;
  Paraboloid surface_;
  HexagonalLattice lattice_;
  int n_struts_;
  model::Model model_;
};

model::Model Builder::build() {
  add_nodes();
  check_apart();
  add_nets_and_ties();
  if (options_.diagonals) add_diagonals();
  add_frame();
  add_cloth();
  add_selections();
  return std::move(model_);
}

int Builder::add_group(const std::string& name, model::ElementKind kind) {
  model::Group group;
  group.name = name;
  group.kind = kind;
  model_.groups.push_back(group);
  return static_cast<int>(model_.groups.size()) - 1;
}

void Builder::add_nodes() {
  for (int k = 0; k <= lattice_.rings(); ++k) {
    const double radius = options_.aperture / 2 * k / lattice_.rings();
    for (int j = 0; j < std::max(1, 6 * k); ++j) {
      const double azimuth = 2 * std::numbers::pi * j / std::max(1, 6 * k);
      const double x = radius * std::cos(azimuth), y = radius * std::sin(azimuth);
      model_.nodes.emplace_back(x, y, surface_.height(x, y));
    }
  }
  double rim_height = -std::numeric_limits<double>::infinity();
  for (int j = 0; j < lattice_.n_rim(); ++j)
    rim_height = std::max(rim_height, model_.nodes[lattice_.rim(j)].z());
  if (!std::isnan(options_.rim_height)) rim_height = options_.rim_height;
  for (int j = 0; j < lattice_.n_rim(); ++j) model_.nodes[lattice_.rim(j)].z() = rim_height;

  for (int i = 0; i < lattice_.n_nodes(); ++i) {
    const Vec3 front = model_.nodes[i];
    model_.nodes.emplace_back(front.x(), front.y(), -front.z() - options_.gap);
  }
}

void Builder::check_apart() const {
  const auto distance = [&](int i) { return model_.nodes[i].z() - model_.nodes[rear(i)].z(); };
  int nearest = 0;
  for (int i = 1; i < lattice_.n_nodes(); ++i)
    if (distance(i) < distance(nearest)) nearest = i;
  if (distance(nearest) > 0) return;
  const Vec3& node = model_.nodes[nearest];
  const bool on_rim = nearest >= lattice_.n_free();
  throw ModelError(fmt::format(
      "front and rear net touch or cross: the {} at x = {:.4g} m, y = {:.4g} m would be {:.4g} m long; "
      "give a larger {} (rim height {:.4g} m, gap {:.4g} m)",
      on_rim ? "distance between the rims" : "tie", node.x(), node.y(), distance(nearest),
      on_rim ? "rim height or gap" : "gap", model_.nodes[lattice_.rim(0)].z(), options_.gap));
}

void Builder::add_nets_and_ties() {
  const int front_net = add_group("front_net", model::ElementKind::cable);
  for (const auto& [i, j] : lattice_.sides()) model_.cables.push_back({{i, j}, front_net});
  const int rear_net = add_group("rear_net", model::ElementKind::cable);
  for (const auto& [i, j] : lattice_.sides()) model_.cables.push_back({{rear(i), rear(j)}, rear_net});
  const int ties = add_group("ties", model::ElementKind::cable);
  for (int i = 0; i < lattice_.n_free(); ++i) model_.cables.push_back({{i, rear(i)}, ties});
}

void Builder::add_diagonals() {
  const int group = add_group("diagonals", model::ElementKind::cable);
  for (int strut = 0; strut < n_struts_; ++strut) {
    const int here = strut_rim_node(strut), next = strut_rim_node(strut + 1);
    model_.cables.push_back({{here, rear(next)}, group});
    model_.cables.push_back({{next, rear(here)}, group});
  }
}

void Builder::add_frame() {
  const auto add_rim = [&](const std::string& name, int first_node) {
    const int group = add_group(name, model::ElementKind::beam);
    model_.groups[group].orientation = Vec3::UnitZ();
    for (int j = 0; j < lattice_.n_rim(); ++j)
      model_.beams.push_back({{first_node + lattice_.rim(j), first_node + lattice_.rim(j + 1)}, group});
  };
  add_rim("front_rim", 0);
  add_rim("rear_rim", lattice_.n_nodes());

  const int struts = add_group("struts", model::ElementKind::beam);
  int held = 0;
  double largest_cosine = -2;
  for (int strut = 0; strut < n_struts_; ++strut) {
    const int node = strut_rim_node(strut), beam = static_cast<int>(model_.beams.size());
    model_.beams.push_back({{node, rear(node)}, struts});
    model_.selections[fmt::format("strut_{}", strut)].beams = {beam};
    const double azimuth = 2 * std::numbers::pi * (1.0 * strut / n_struts_ - options_.held_strut / 360);
    if (std::cos(azimuth) <= largest_cosine) continue;
    largest_cosine = std::cos(azimuth);
    held = beam;
  }
  model_.selections["held_strut"].beams = {held};
}

void Builder::add_cloth() {
  const int cloth = add_group("cloth", model::ElementKind::membrane);
  for (const auto& facet : lattice_.facets()) model_.membranes.push_back({facet, cloth});
}

void Builder::add_selections() {
  for (int i = 0; i < lattice_.n_nodes(); ++i) {
    const std::string kind = i < lattice_.n_free() ? "net_nodes" : "rim_nodes";
    model_.selections["front_" + kind].nodes.push_back(i);
    model_.selections["rear_" + kind].nodes.push_back(rear(i));
  }
}

/// Number of struts. @throws ModelError where rings, struts or gap make no truss.
int check_truss(const PerimeterTrussOptions& options) {
  if (options.rings < 1)
    throw ModelError(fmt::format("the net needs at least one ring, not {}", options.rings));
  if (!(options.gap >= 0))
    throw ModelError(
        fmt::format("the gap between front and rear net must not be negative, not {} m", options.gap));
  const int n_rim = 6 * options.rings;
  const int struts = options.struts == 0 ? n_rim / 2 : options.struts;
  if (struts >= fewest_struts && n_rim % struts == 0) return struts;
  std::string possible;
  for (int n = fewest_struts; n <= n_rim; ++n)
    if (n_rim % n == 0) possible += fmt::format("{}{}", possible.empty() ? "" : ", ", n);
  throw ModelError(fmt::format(
      "{} struts cannot be spread evenly over the {} nodes of the rim (6 for each of {} rings); possible: {}",
      struts, n_rim, options.rings, possible));
}

}  // namespace

model::Model make_perimeter_truss(const PerimeterTrussOptions& options) {
  const int struts = check_truss(options);
  return Builder(options, struts).build();
}

}  // namespace tautline::reflector
