#include <tautline/reflector/umbrella.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <Eigen/Dense>
#include <reflector/umbrella_net.hpp>
#include <tautline/core/error.hpp>

namespace tautline::reflector {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr int fewest_spokes = 5;  // with fewer the rings of the net would have to push
constexpr int fewest_rings = 3;

/// Where the parts of an umbrella are before form-finding.
class Layout {
 public:
  Layout(const UmbrellaOptions& options, const UmbrellaNet& net)
      : options_(options), net_(net), surface_(make_paraboloid(options)) {
    for (int s = 0; s < net.n_spokes(); ++s) tip_radius_.push_back(tip_radius(s));
  }

  Vec2 direction(int s) const {
    const double azimuth = 2 * std::numbers::pi * s / net_.n_spokes();
    return {std::cos(azimuth), std::sin(azimuth)};
  }
  /// Nodes of a net of the pattern on the surface, in their order.
  Points nodes(NetPattern pattern) const;

 private:
  Vec3 on_surface(const Vec2& p) const { return {p.x(), p.y(), surface_.height(p.x(), p.y())}; }
  double tip_radius(int s) const;
  /// Radius of ring k on a spoke whose tip is at `tip`.
  double ring_radius(double tip, int k) const {
    const double part = double(k) / net_.n_rings();
    return options_.hub_radius + part * (options_.last_ring * tip - options_.hub_radius);
  }
  double place(int k, int i) const;
  Vec2 tip(int s) const { return tip_radius_[s % net_.n_spokes()] * direction(s); }
  Vec2 ring(NetPattern pattern, int s, int k, int t) const;
  Vec2 peripheral(NetPattern pattern, int s, int i) const;
  Vec2 sagging(int s, const Vec2& a, const Vec2& b, double sag, double place) const;
  Vec2 crossing(NetPattern pattern, int s, int side) const;

  const UmbrellaOptions& options_;
  const UmbrellaNet& net_;
  Paraboloid surface_;
  std::vector<double> tip_radius_;
};

/// The tip lies on the surface, at the radius given or a fork's length from the apex. That distance grows
/// with the radius, as the surface rises from the plane of the spokes.
double Layout::tip_radius(int s) const {
  const auto& given = options_.tip_radius;
  if (!given.empty()) return given[given.size() == 1 ? 0 : static_cast<std::size_t>(s)];
  const Vec2 outwards = direction(s);
  const double length = options_.fork_length;
  const auto distance = [&](double radius) {
    const Vec2 p = radius * outwards;
    return std::hypot(radius - options_.apex_radius, surface_.height(p.x(), p.y()));
  };
  double inner = options_.apex_radius, outer = inner + length;
  if (distance(inner) >= length)
    throw ModelError(
        fmt::format("the links of the fork of spoke {} do not reach beyond its apex: the surface is {:.4g} m "
                    "above it, and fork_length is {:.4g} m",
                    s, distance(inner), length));
  for (int i = 0; i < 100 && outer - inner > 1e-15 * outer; ++i) {
    const double middle = (inner + outer) / 2;
    (distance(middle) < length ? inner : outer) = middle;
  }
  return (inner + outer) / 2;
}

/// A point between a and b on a parabola that sags inwards; `sag` over the span.
Vec2 Layout::sagging(int s, const Vec2& a, const Vec2& b, double sag, double place) const {
  const Vec2 inwards = -(direction(s) + direction(s + 1)).normalized();
  return (1 - place) * a + place * b + 4 * place * (1 - place) * sag * (b - a).norm() * inwards;
}

/// Place of the i-th node on ring k between the spokes, 0 to 1. Columns are straight, parallel to the
/// bisector of the spokes, and begin where a ring meets a spoke.
double Layout::place(int k, int i) const {
  if (net_.front() == NetPattern::triangles || net_.front() == NetPattern::belts)
    return double(i) / net_.parts(k);
  const int y = net_.column(k, i);
  const double off = ring_radius(tip_radius_.front(), std::abs(y)) / ring_radius(tip_radius_.front(), k);
  return y == 0 ? 0.5 : 0.5 + (y > 0 ? 0.5 : -0.5) * off;
}

Vec2 Layout::ring(NetPattern pattern, int s, int k, int t) const {
  const auto on_spoke = [&](int spoke) -> Vec2 {
    return ring_radius(tip_radius_[spoke % net_.n_spokes()], k) * direction(spoke);
  };
  const double otherwise = pattern == NetPattern::triangles ? options_.cord_sag : 0;
  const double last = std::isnan(options_.ring_sag) ? otherwise : options_.ring_sag;
  const double sag = pattern == NetPattern::belts ? 0 : last;
  return sagging(s, on_spoke(s), on_spoke(s + 1), double(k) / net_.n_rings() * sag, place(k, t));
}

/// The peripheral cord is straight where no connector pulls at it.
Vec2 Layout::peripheral(NetPattern pattern, int s, int i) const {
  if (pattern == NetPattern::coarse_triangles && i % 2 == 1)
    return (peripheral(pattern, s, i - 1) + peripheral(pattern, s, i + 1)) / 2;
  const double sag = pattern == NetPattern::belts ? 0 : options_.cord_sag;
  return sagging(s, tip(s), tip(s + 1), sag, place(net_.n_rings(), i));
}

/// Where the two cords would cross if they were straight in plan; without them, on the peripheral cord.
Vec2 Layout::crossing(NetPattern pattern, int s, int side) const {
  const int n = net_.n_rings(), t = side == 0 ? 1 : n - 1;
  if (pattern != NetPattern::triangles) return (tip(s + side) + peripheral(pattern, s, t)) / 2;
  const Vec2 from = ring(pattern, s, n, t), to = tip(s + side), other = ring(pattern, s, n, side * n);
  Eigen::Matrix2d m;
  m << to - from, other - peripheral(pattern, s, t);
  return from + m.inverse().eval().row(0).dot(other - from) * (to - from);
}

Points Layout::nodes(NetPattern pattern) const {
  const int n_spokes = net_.n_spokes(), n = net_.n_rings();
  Points nodes(net_.n_nodes());
  for (int s = 0; s < n_spokes; ++s) {
    nodes[net_.hub(s)] = on_surface(options_.hub_radius * direction(s));
    for (int k = 1; k <= n; ++k)
      for (int t = 0; t < net_.parts(k); ++t) nodes[net_.ring(s, k, t)] = on_surface(ring(pattern, s, k, t));
    for (int i = 0; i < net_.parts(n); ++i)
      nodes[net_.peripheral(s, i)] = on_surface(peripheral(pattern, s, i));
    for (int side = 0; net_.has_crossings() && side < 2; ++side)
      nodes[net_.crossing(s, side)] = on_surface(crossing(pattern, s, side));
  }
  return nodes;
}

/// Adds the parts of the reflector to a model, one group after the other.
class Builder {
 public:
  explicit Builder(const UmbrellaOptions& options)
      : options_(options),
        net_(options.spokes, options.rings, options.front_pattern),
        layout_(options, net_) {}

  model::Model build();

 private:
  int rear(int front_node) const { return front_node + net_.n_nodes(); }
  int root(int s) const { return 2 * net_.n_nodes() + s % net_.n_spokes(); }
  int joint(int s) const { return root(s) + net_.n_spokes(); }
  int apex(int s) const { return joint(s) + net_.n_spokes(); }
  int add_group(const std::string& name, model::ElementKind kind);
  void add_nodes();
  void check_apart() const;
  void add_nets();
  void add_ties();
  void add_cords();
  void add_spokes();
  void add_selections();

  const UmbrellaOptions& options_;
  UmbrellaNet net_;
  Layout layout_;
  model::Model model_;
};

model::Model Builder::build() {
  add_nodes();
  check_apart();
  add_nets();
  add_ties();
  add_cords();
  add_spokes();
  const int cloth = add_group("cloth", model::ElementKind::membrane);
  for (const auto& facet : net_.facets()) model_.membranes.push_back({facet, cloth});
  const int hub = add_group("hub", model::ElementKind::mass);
  for (int s = 0; s < net_.n_spokes(); ++s) model_.masses.push_back({{root(s)}, hub});
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
  model_.nodes = layout_.nodes(options_.front_pattern);
  for (const Vec3& node : layout_.nodes(options_.rear_pattern.value_or(options_.front_pattern)))
    model_.nodes.emplace_back(node.x(), node.y(), -node.z());
  for (const double radius : {options_.hub_radius, options_.joint_radius, options_.apex_radius})
    for (int s = 0; s < net_.n_spokes(); ++s) {
      const Vec2 p = radius * layout_.direction(s);
      model_.nodes.emplace_back(p.x(), p.y(), 0);
    }
}

void Builder::check_apart() const {
  int nearest = 0;
  for (int i = 1; i < net_.n_nodes(); ++i)
    if (model_.nodes[i].z() < model_.nodes[nearest].z()) nearest = i;
  const Vec3& node = model_.nodes[nearest];
  if (node.z() > 0) return;
  throw ModelError(fmt::format(
      "front and rear net touch or cross: the tie at x = {:.4g} m, y = {:.4g} m would be {:.4g} m "
      "long; give a larger surface_height ({:.4g} m)",
      node.x(), node.y(), 2 * node.z(), options_.surface_height));
}

/// Front and rear groups of one name follow each other.
void Builder::add_nets() {
  const auto front = net_.cords(options_.front_pattern, options_.separate_rings, options_.end_cords);
  auto rear_cords = net_.cords(options_.rear_pattern.value_or(options_.front_pattern),
                               options_.separate_rings, options_.end_cords);
  const auto add = [&](const std::string& name, const std::vector<Side>& sides, int offset) {
    const int group = add_group(name, model::ElementKind::cable);
    for (const auto& [i, j] : sides) model_.cables.push_back({{i + offset, j + offset}, group});
  };
  for (const auto& [name, sides] : front) {
    add("front_" + name, sides, 0);
    const auto same = std::find_if(rear_cords.begin(), rear_cords.end(),
                                   [&](const auto& group) { return group.name == name; });
    if (same == rear_cords.end()) continue;
    add("rear_" + name, same->sides, rear(0));
    rear_cords.erase(same);
  }
  for (const auto& [name, sides] : rear_cords) add("rear_" + name, sides, rear(0));
}

void Builder::add_ties() {
  const int ties = add_group("ties", model::ElementKind::cable);
  for (int i = 0; i < net_.n_free(); ++i) {
    const int count = options_.paired_ties && net_.over_spoke(i) ? 2 : 1;
    for (int k = 0; k < count; ++k) model_.cables.push_back({{i, rear(i)}, ties});
  }
}

void Builder::add_cords() {
  const int fork_cords = add_group("fork_cords", model::ElementKind::cable);
  for (int s = 0; s < net_.n_spokes(); ++s)
    model_.cables.push_back({{net_.tip(s), rear(net_.tip(s))}, fork_cords});
  const int apex_cords = add_group("apex_cords", model::ElementKind::cable);
  for (int s = 0; s < net_.n_spokes(); ++s) model_.cables.push_back({{apex(s), apex(s + 1)}, apex_cords});
  const int joint_cords = add_group("joint_cords", model::ElementKind::cable);
  for (int s = 0; s < net_.n_spokes(); ++s) model_.cables.push_back({{joint(s), joint(s + 1)}, joint_cords});
}

void Builder::add_spokes() {
  const auto add_links = [&](const std::string& name, const auto& nodes) {
    const int group = add_group(name, model::ElementKind::beam);
    model_.groups[group].orientation = Vec3::UnitZ();
    for (int s = 0; s < net_.n_spokes(); ++s) {
      model_.selections[fmt::format("spoke_{}", s)].beams.push_back(static_cast<int>(model_.beams.size()));
      model_.beams.push_back({nodes(s), group});
    }
  };
  add_links("root_links", [&](int s) { return Side{root(s), joint(s)}; });
  add_links("intermediate_links", [&](int s) { return Side{joint(s), apex(s)}; });
  add_links("front_links", [&](int s) { return Side{apex(s), net_.tip(s)}; });
  add_links("rear_links", [&](int s) { return Side{apex(s), rear(net_.tip(s))}; });
}

void Builder::add_selections() {
  auto& selections = model_.selections;
  for (int i = 0; i < net_.n_free(); ++i) {
    selections["front_net_nodes"].nodes.push_back(i);
    selections["rear_net_nodes"].nodes.push_back(rear(i));
  }
  for (int s = 0; s < net_.n_spokes(); ++s) {
    for (const int node : {root(s), net_.hub(s), rear(net_.hub(s))})
      selections["hub_nodes"].nodes.push_back(node);
    for (const int node : {net_.tip(s), rear(net_.tip(s))}) selections["tips"].nodes.push_back(node);
  }
}

void check_tips(const UmbrellaOptions& options) {
  const auto n = options.tip_radius.size();
  if ((n > 0) == (options.fork_length > 0))
    throw ModelError("the tips need either a positive fork_length or a tip_radius");
  if (n > 1 && n != static_cast<std::size_t>(options.spokes))
    throw ModelError(fmt::format("tip_radius has {} numbers for {} spokes", n, options.spokes));
  for (const double radius : options.tip_radius)
    if (!(radius > options.apex_radius))
      throw ModelError(fmt::format("tip_radius = {:g} m is not outside apex_radius = {:g} m", radius,
                                   options.apex_radius));
}

/// The rear net has a node under each of the front net, so not every pattern fits under every other.
void check_patterns(const UmbrellaOptions& options) {
  const NetPattern front = options.front_pattern, rear = options.rear_pattern.value_or(front);
  if (front == NetPattern::coarse_triangles)
    throw ModelError(
        "front_pattern: coarse_triangles is a rear net's; the same with fewer rings is triangles");
  if (rear == front || rear == NetPattern::belts) return;
  if (rear != NetPattern::coarse_triangles || front != NetPattern::triangles)
    throw ModelError(
        "rear_pattern does not fit under front_pattern: it is the same, belts, or coarse_triangles under "
        "triangles");
  if (options.rings % 2 == 1)
    throw ModelError(
        fmt::format("rear_pattern: coarse_triangles needs an even number of rings, not {}", options.rings));
}

/// @throws ModelError where the numbers make no umbrella
void check_umbrella(const UmbrellaOptions& options) {
  if (options.spokes < fewest_spokes)
    throw ModelError(fmt::format(
        "an umbrella needs at least {} spokes, not {}: with fewer the rings of its net would push",
        fewest_spokes, options.spokes));
  if (options.rings < fewest_rings)
    throw ModelError(fmt::format("the net needs at least {} rings, not {}", fewest_rings, options.rings));
  const bool outwards = options.hub_radius > 0 && options.joint_radius > options.hub_radius &&
                        options.apex_radius > options.joint_radius;
  if (!outwards)
    throw ModelError(fmt::format(
        "a spoke goes outwards: expected 0 < hub_radius < joint_radius < apex_radius, not {:g}, {:g}, {:g} m",
        options.hub_radius, options.joint_radius, options.apex_radius));
  check_tips(options);
  check_patterns(options);
  if (!(options.last_ring > 0 && options.last_ring < 1))
    throw ModelError(fmt::format("last_ring must be between 0 and 1, not {:g}", options.last_ring));
  const auto check_sag = [](const char* name, double sag) {
    if (!std::isnan(sag) && !(sag >= 0 && sag < 0.5))
      throw ModelError(fmt::format("{} must be at least 0 and below 0.5, not {:g}", name, sag));
  };
  check_sag("cord_sag", options.cord_sag);
  check_sag("ring_sag", options.ring_sag);
}

}  // namespace

model::Model make_umbrella(const UmbrellaOptions& options) {
  check_umbrella(options);
  return Builder(options).build();
}

}  // namespace tautline::reflector
