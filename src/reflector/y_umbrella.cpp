#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <reflector/y_umbrella_layout.hpp>
#include <tautline/core/error.hpp>
#include <tautline/reflector/y_umbrella.hpp>
#include <utility>

namespace tautline::reflector {

namespace {

using model::ElementKind;

constexpr int fewest_spokes = 3;

/// Nodes of one side, front or rear, by spoke s and place.
struct SideNodes {
  std::vector<std::vector<int>> radial;                   ///< [s][k], k = 0 on the hub
  std::vector<std::vector<std::vector<int>>> tangential;  ///< [s][k - 1][t], t from spoke to spoke
  std::vector<std::vector<int>> ring, outer;              ///< [s][i], i = 0 on the spoke
};

/// Adds the parts of the reflector to a model, one group after the other.
class Builder {
 public:
  explicit Builder(const YUmbrellaOptions& options) : options_(options), layout_(options) {}

  model::Model build();

 private:
  int n_spokes() const { return options_.spokes; }
  int n_parts() const { return options_.parts; }
  /// Node i of a line of nodes from spoke to spoke; i = parts is the first of the next sector.
  int of(const std::vector<std::vector<int>>& line, int s, int i) const {
    return i < n_parts() ? line[s][i] : line[(s + 1) % n_spokes()][0];
  }
  int add_node(const Vec3& position);
  int add_group(const std::string& name, ElementKind kind);
  void add_cable(int group, int a, int b) { model_.cables.push_back({{a, b}, group}); }
  /// Straight beams one behind the other. @return their numbers
  std::vector<int> add_beams(int group, const std::vector<int>& nodes);
  void add_centre(SideNodes& side, bool front);
  void add_periphery();
  /// Nodes on the surface between two others and these.
  std::vector<int> shaped(int s, int i, double from, double to, int first, int last);
  void add_net(const std::string& prefix, const SideNodes& side);
  void add_ties();
  void add_shaping_beams();
  void add_braces();
  void add_spokes();
  void add_extensions();
  void add_selections();

  const YUmbrellaOptions& options_;
  YUmbrellaLayout layout_;
  model::Model model_;
  SideNodes front_, rear_;
  std::vector<std::vector<int>> crossing_;  ///< [s][i], i from 1
};

model::Model Builder::build() {
  add_centre(front_, true);
  add_centre(rear_, false);
  add_periphery();
  add_net("front_", front_);
  add_net("rear_", rear_);
  add_ties();
  add_braces();
  add_spokes();
  add_shaping_beams();
  if (options_.aperture / 2 > layout_.tip_radius()) add_extensions();
  add_selections();
  return std::move(model_);
}

int Builder::add_node(const Vec3& position) {
  model_.nodes.push_back(position);
  return static_cast<int>(model_.nodes.size()) - 1;
}

int Builder::add_group(const std::string& name, ElementKind kind) {
  auto& group = model_.groups.emplace_back();
  group.name = name;
  group.kind = kind;
  if (kind == ElementKind::beam) group.orientation = Vec3::UnitZ();
  return static_cast<int>(model_.groups.size()) - 1;
}

std::vector<int> Builder::add_beams(int group, const std::vector<int>& nodes) {
  std::vector<int> beams;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    beams.push_back(static_cast<int>(model_.beams.size()));
    model_.beams.push_back({{nodes[i], nodes[i + 1]}, group});
  }
  return beams;
}

void Builder::add_centre(SideNodes& side, bool front) {
  const auto place = [&](const Vec3& p) { return add_node(front ? p : Vec3(p.x(), p.y(), -p.z())); };
  for (int s = 0; s < n_spokes(); ++s) {
    auto& radial = side.radial.emplace_back();
    for (int k = 0; k <= options_.rings; ++k) radial.push_back(place(layout_.tangential(s, k, 0)));
  }
  for (int s = 0; s < n_spokes(); ++s) {
    auto& sector = side.tangential.emplace_back();
    for (int k = 1; k <= options_.rings; ++k) {
      auto& cord = sector.emplace_back();
      const int parts = layout_.parts_of(k);
      cord.push_back(side.radial[s][k]);
      for (int t = 1; t < parts; ++t) cord.push_back(place(layout_.tangential(s, k, double(t) / parts)));
      cord.push_back(side.radial[(s + 1) % n_spokes()][k]);
    }
  }
}

void Builder::add_periphery() {
  for (auto* line : {&front_.ring, &front_.outer, &rear_.ring, &rear_.outer, &crossing_})
    line->assign(n_spokes(), {});
  for (int s = 0; s < n_spokes(); ++s)
    for (int i = 0; i < n_parts(); ++i) {
      const auto braced = layout_.braced(s, i);
      front_.ring[s].push_back(add_node(braced.ring));
      front_.outer[s].push_back(add_node(braced.outer));
      rear_.ring[s].push_back(add_node(braced.rear_ring));
      rear_.outer[s].push_back(add_node(braced.rear_outer));
      crossing_[s].push_back(i == 0 ? -1 : add_node(braced.crossing));
    }
}

void Builder::add_net(const std::string& prefix, const SideNodes& side) {
  const int radials = add_group(prefix + "radials", ElementKind::cable);
  for (int s = 0; s < n_spokes(); ++s)
    for (int k = 0; k <= options_.rings; ++k)
      add_cable(radials, side.radial[s][k], k < options_.rings ? side.radial[s][k + 1] : side.ring[s][0]);
  const int tangentials = add_group(prefix + "tangentials", ElementKind::cable);
  for (const auto& sector : side.tangential)
    for (const auto& cord : sector)
      for (std::size_t t = 0; t + 1 < cord.size(); ++t) add_cable(tangentials, cord[t], cord[t + 1]);
  for (const auto& [name, line] : {std::pair{"ring", &side.ring}, std::pair{"outer", &side.outer}}) {
    const int group = add_group(prefix + name, ElementKind::cable);
    for (int s = 0; s < n_spokes(); ++s)
      for (int i = 0; i < n_parts(); ++i) add_cable(group, of(*line, s, i), of(*line, s, i + 1));
  }
}

void Builder::add_ties() {
  const int ties = add_group("ties", ElementKind::cable);
  for (int s = 0; s < n_spokes(); ++s) {
    for (int k = 1; k <= options_.rings; ++k) add_cable(ties, front_.radial[s][k], rear_.radial[s][k]);
    for (int k = 0; k < options_.rings; ++k)
      for (std::size_t t = 1; t + 1 < front_.tangential[s][k].size(); ++t)
        add_cable(ties, front_.tangential[s][k][t], rear_.tangential[s][k][t]);
  }
}

std::vector<int> Builder::shaped(int s, int i, double from, double to, int first, int last) {
  std::vector<int> nodes{first};
  for (int j = 1; j < options_.beam_parts; ++j)
    nodes.push_back(add_node(layout_.on_surface(s, i, from + (to - from) * j / options_.beam_parts)));
  nodes.push_back(last);
  return nodes;
}

void Builder::add_shaping_beams() {
  const int group = add_group("shaping_beams", ElementKind::beam);
  const int ties = add_group("middle_ties", ElementKind::cable);
  for (int s = 0; s < n_spokes(); ++s)
    for (int i = 1; i < n_parts(); ++i) {
      const auto nodes =
          shaped(s, i, layout_.ring_radius(i), layout_.tip_radius(), front_.ring[s][i], front_.outer[s][i]);
      add_beams(group, nodes);
      add_cable(ties, nodes[options_.beam_parts / 2], crossing_[s][i]);
      for (std::size_t j = 1; j + 1 < nodes.size(); ++j)
        model_.selections["front_net_nodes"].nodes.push_back(nodes[j]);
    }
}

void Builder::add_braces() {
  const int front = add_group("front_braces", ElementKind::cable);
  const int rear = add_group("rear_braces", ElementKind::cable);
  for (int s = 0; s < n_spokes(); ++s)
    for (int i = 1; i < n_parts(); ++i) {
      const int middle = crossing_[s][i];
      add_cable(front, front_.ring[s][i], middle);
      add_cable(front, front_.outer[s][i], middle);
      add_cable(rear, middle, rear_.outer[s][i]);
      add_cable(rear, middle, rear_.ring[s][i]);
    }
}

void Builder::add_spokes() {
  const int stems = add_group("stems", ElementKind::beam),
            branches = add_group("branches", ElementKind::beam), ends = add_group("ends", ElementKind::beam);
  const int tip_cords = add_group("tip_cords", ElementKind::cable);
  const int fork_cords = add_group("fork_cords", ElementKind::cable);
  std::vector<int> forks;
  for (int s = 0; s < n_spokes(); ++s) {
    auto& beams = model_.selections[fmt::format("spoke_{}", s)].beams;
    const auto add = [&](int group, const std::vector<int>& nodes) {
      for (const int beam : add_beams(group, nodes)) beams.push_back(beam);
    };
    const int root = add_node(layout_.in_plane(s, options_.hub_radius));
    forks.push_back(add_node(layout_.in_plane(s, options_.fork_radius)));
    add(stems, {root, forks.back()});
    add(branches, {forks.back(), front_.ring[s][0]});
    add(branches, {forks.back(), rear_.ring[s][0]});
    add(ends, {front_.ring[s][0], front_.outer[s][0]});
    add(ends, {rear_.ring[s][0], rear_.outer[s][0]});
    add_cable(tip_cords, front_.outer[s][0], rear_.outer[s][0]);
    auto& hub = model_.selections["hub_nodes"].nodes;
    hub.insert(hub.end(), {root, front_.radial[s][0], rear_.radial[s][0]});
    auto& tips = model_.selections["tips"].nodes;
    tips.insert(tips.end(), {front_.outer[s][0], rear_.outer[s][0]});
  }
  for (int s = 0; s < n_spokes(); ++s) add_cable(fork_cords, forks[s], forks[(s + 1) % n_spokes()]);
}

void Builder::add_extensions() {
  const int group = add_group("extensions", ElementKind::beam);
  const int cord = add_group("front_edge", ElementKind::cable);
  const double edge = options_.aperture / 2;
  std::vector<int> last;
  for (int s = 0; s < n_spokes(); ++s)
    for (int i = 0; i < n_parts(); ++i) {
      last.push_back(add_node(layout_.on_surface(s, i, edge)));
      const auto nodes = shaped(s, i, layout_.tip_radius(), edge, front_.outer[s][i], last.back());
      add_beams(group, nodes);
      auto& free = model_.selections["front_net_nodes"].nodes;
      if (i > 0) free.insert(free.end(), nodes.begin() + 1, nodes.end());
    }
  for (std::size_t e = 0; e < last.size(); ++e) add_cable(cord, last[e], last[(e + 1) % last.size()]);
}

void Builder::add_selections() {
  const auto add_free = [&](const std::string& name, const SideNodes& side) {
    auto& nodes = model_.selections[name].nodes;
    for (int s = 0; s < n_spokes(); ++s) {
      nodes.insert(nodes.end(), side.radial[s].begin() + 1, side.radial[s].end());
      for (const auto& cord : side.tangential[s]) nodes.insert(nodes.end(), cord.begin() + 1, cord.end() - 1);
      nodes.insert(nodes.end(), side.ring[s].begin() + 1, side.ring[s].end());
      nodes.insert(nodes.end(), side.outer[s].begin() + 1, side.outer[s].end());
    }
  };
  add_free("front_net_nodes", front_);
  add_free("rear_net_nodes", rear_);
  auto& surface = model_.selections["front_surface"];
  for (const char* group : {"front_radials", "front_tangentials", "front_ring", "front_outer", "front_edge"})
    if (model_.find_group(group) >= 0)
      for (const int cable : model_.select(group).cables) surface.cables.push_back(cable);
  for (const char* group : {"shaping_beams", "extensions"})
    if (model_.find_group(group) >= 0)
      for (const int beam : model_.select(group).beams) surface.beams.push_back(beam);
}

void check_radii(const YUmbrellaOptions& options) {
  const double tip = std::isnan(options.tip_radius) ? options.aperture / 2 : options.tip_radius;
  const bool outwards = options.hub_radius > 0 && options.fork_radius > options.hub_radius &&
                        options.ring_radius > options.fork_radius && tip > options.ring_radius;
  if (!outwards)
    throw ModelError(
        fmt::format("a spoke goes outwards: expected 0 < hub_radius < fork_radius < ring_radius < "
                    "tip_radius, not {:g}, {:g}, {:g}, {:g} m",
                    options.hub_radius, options.fork_radius, options.ring_radius, tip));
  if (tip > options.aperture / 2)
    throw ModelError(
        fmt::format("tip_radius = {:g} m is outside aperture/2 = {:g} m", tip, options.aperture / 2));
}

/// @throws ModelError where the numbers make no umbrella
void check(const YUmbrellaOptions& options) {
  if (options.spokes < fewest_spokes)
    throw ModelError(
        fmt::format("an umbrella needs at least {} spokes, not {}", fewest_spokes, options.spokes));
  if (options.rings < 1)
    throw ModelError(fmt::format("the net needs at least one ring, not {}", options.rings));
  if (options.parts < 2)
    throw ModelError(fmt::format("parts = {} leaves no place for a beam between the spokes", options.parts));
  if (options.beam_parts < 2 || options.beam_parts % 2 != 0)
    throw ModelError(
        fmt::format("beam_parts = {} is not even: a tie holds each beam's middle", options.beam_parts));
  check_radii(options);
  for (const auto& [name, sag] : {std::pair{"ring_sag", options.ring_sag},
                                  {"rear_ring_sag", options.rear_ring_sag},
                                  {"rear_outer_sag", options.rear_outer_sag}})
    if (!(sag >= 0 && sag < 0.5))
      throw ModelError(fmt::format("{} must be at least 0 and below 0.5, not {:g}", name, sag));
}

}  // namespace

model::Model make_y_umbrella(const YUmbrellaOptions& options) {
  check(options);
  return Builder(options).build();
}

}  // namespace tautline::reflector
