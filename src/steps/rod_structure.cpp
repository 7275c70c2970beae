#include "steps/rod_structure.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/element/beam.hpp>

#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

constexpr double poisson_ratio =
    0.3;  // of the round section behind the torsion stiffness where none is given

double of_link(const std::vector<double>& values, int k) {
  return values.size() == 1 ? values[0] : values.at(static_cast<std::size_t>(k));
}

double azimuth(int rod, int rods) {
  return 2 * std::numbers::pi * rod / rods;
}

Vec3 outward(int rod, int rods) {
  const double angle = azimuth(rod, rods);
  return {std::cos(angle), std::sin(angle), 0};
}

/// From X and Y in the meridian plane of a rod.
Vec3 in_space(const Vec3& outward, double x, double y) {
  return x * outward + y * Vec3::UnitZ();
}

void check_cables(const rod::Umbrella& umbrella, const VecX& stiffness) {
  if (umbrella.cables.options.law != rod::CableLaw::linear)
    throw ModelError(
        "the finite-element model of a rod-umbrella has cables of the linear law only: leave out "
        "cable.law, or solve by rod_shaping with given stiffness");
  for (int k = 0; k < stiffness.size(); ++k)
    if (!std::isfinite(stiffness[k]) || stiffness[k] < 0)
      throw ModelError(
          fmt::format("no structure can be built: the cable of parallel {} would have to push; see the "
                      "warnings of the rod_shaping step",
                      k + 1));
}

void add_groups(model::Model& model, const rod::Umbrella& umbrella, const rod::UmbrellaOptions& options,
                const VecX& stiffness) {
  const int links = umbrella.rod.links();
  for (int k = 0; k < links; ++k) {
    auto& group = model.groups.emplace_back();
    group.name = fmt::format("link_{}", k + 1);
    group.kind = model::ElementKind::beam;
    group.orientation = Vec3::UnitZ();
    const double bending = umbrella.rod.bending_stiffness[k];
    group.beam.axial_stiffness = of_link(options.axial_stiffness, k);
    group.beam.bending_stiffness_2 = group.beam.bending_stiffness_3 = bending;
    group.beam.mass_per_length = of_link(options.mass_per_length, k);
    group.beam.torsion_stiffness = options.torsion_stiffness.empty() ? bending / (1 + poisson_ratio)
                                                                     : of_link(options.torsion_stiffness, k);
  }
  for (int k = 0; k < links; ++k) {
    if (stiffness[k] == 0) continue;
    auto& group = model.groups.emplace_back();
    group.name = fmt::format("parallel_{}", k + 1);
    group.kind = model::ElementKind::cable;
    group.cable.axial_stiffness = stiffness[k];
  }
}

void add_rod(model::Model& model, const rod::Umbrella& umbrella, const VecX& lengths, int rod, int rods) {
  const int links = umbrella.rod.links(), first = static_cast<int>(model.nodes.size());
  const Vec3 out = outward(rod, rods);
  const rod::Root root = umbrella.root_at(0), stop = umbrella.root_at(1);
  auto& selection = model.selections[fmt::format("rod_{}", rod)];
  double s = 0;
  for (int k = 0; k <= links; ++k) {
    if (k > 0) s += lengths[k - 1];
    model.nodes.push_back(
        in_space(out, root.x + s * std::cos(root.angle), root.y + s * std::sin(root.angle)));
    selection.nodes.push_back(first + k);
  }
  for (int k = 0; k < links; ++k) {
    auto& beam = model.beams.emplace_back();
    beam.nodes = {first + k, first + k + 1};
    beam.group = model.find_group(fmt::format("link_{}", k + 1));
    Mat<3, 2> x;
    x << model.nodes[first + k], model.nodes[first + k + 1];
    beam.frame = element::beam_frame(x, Vec3::UnitZ());
    selection.beams.push_back(static_cast<int>(model.beams.size()) - 1);
  }
  model.selections["roots"].nodes.push_back(first);
  model.selections["tips"].nodes.push_back(first + links);
  auto& turn = model.loads.emplace_back();
  turn.name = "turn";
  turn.nodes = {first};
  turn.displacement = in_space(out, stop.x - root.x, stop.y - root.y);
  turn.rotation = (stop.angle - root.angle) * out.cross(Vec3::UnitZ());
}

void add_parallels(model::Model& model, int rods, int links) {
  for (int k = 1; k <= links; ++k) {
    const int group = model.find_group(fmt::format("parallel_{}", k));
    for (int rod = 0; rod < rods && group >= 0; ++rod) {
      auto& cable = model.cables.emplace_back();
      cable.nodes = {rod * (links + 1) + k, (rod + 1) % rods * (links + 1) + k};
      cable.group = group;
    }
  }
}

/// What is reported of node k of the rods, each the mean over all of them.
struct NodeMeans {
  double x = 0, y = 0, angle = 0, moment = 0, reaction = 0, strain = 0, stiffness = 0;
  int moments = 0, cables = 0;
};

class RodsReport {
 public:
  RodsReport(Context& context, const model::Response& response)
      : umbrella_(*context.umbrella),
        model_(context.system().model()),
        state_(context.system().state()),
        response_(response),
        rods_(umbrella_.cables.rods),
        links_(umbrella_.rod.links()),
        nodes_(static_cast<std::size_t>(links_ + 1)) {
    add_nodes();
    add_moments();
    add_cables();
  }

  Json json() const {
    Json entry;
    const auto list = [&](const char* name, auto get) {
      Json values = Json::array();
      for (int k = 1; k <= links_; ++k) values.push_back(get(nodes_[static_cast<std::size_t>(k)]));
      entry[name] = values;
    };
    list("X", [](const NodeMeans& n) { return n.x; });
    list("Y", [](const NodeMeans& n) { return n.y; });
    list("theta", [](const NodeMeans& n) { return n.angle; });
    list("reaction", [](const NodeMeans& n) { return n.reaction; });
    list("strain", [](const NodeMeans& n) { return n.strain; });
    list("stiffness", [](const NodeMeans& n) { return n.stiffness; });
    Json moments = Json::array();
    for (const auto& node : nodes_) moments.push_back(node.moments > 0 ? node.moment / node.moments : 0);
    entry["moments"] = moments;
    entry["asymmetry"] = asymmetry();
    add_errors(entry);
    return entry;
  }

 private:
  Vec3 position(int node) const { return model_.nodes[node] + state_.displacement[node]; }
  /// Distance from the axis and height.
  std::array<double, 2> in_meridian(int node) const {
    const Vec3 p = position(node);
    return {p.head<2>().norm(), p.z()};
  }

  void add_nodes() {
    const Vec3 straight(std::cos(umbrella_.straight_angle), 0, std::sin(umbrella_.straight_angle));
    for (int rod = 0; rod < rods_; ++rod) {
      const Vec3 out = outward(rod, rods_);
      for (int k = 0; k <= links_; ++k) {
        const int node = rod * (links_ + 1) + k;
        auto& mean = nodes_[static_cast<std::size_t>(k)];
        const auto [x, y] = in_meridian(node);
        const Vec3 tangent = state_.rotation[node] * in_space(out, straight.x(), straight.z());
        mean.x += x / rods_;
        mean.y += y / rods_;
        mean.angle += std::atan2(tangent.z(), tangent.dot(out)) / rods_;
      }
    }
  }

  /// Moments that raise theta, on both sides of each node; local axis 2 of the beams is the other way round.
  void add_moments() {
    const int nodes_of_rods = rods_ * (links_ + 1);
    for (std::size_t i = 0; i < model_.beams.size(); ++i)
      for (int end = 0; end < 2; ++end) {
        const int node = model_.beams[i].nodes[static_cast<std::size_t>(end)];
        if (node >= nodes_of_rods) continue;
        auto& mean = nodes_[static_cast<std::size_t>(node % (links_ + 1))];
        mean.moment += (end == 0 ? 1 : -1) * response_.beams[i].end_moment(1, end);
        ++mean.moments;
      }
  }

  void add_cables() {
    for (std::size_t i = 0; i < model_.cables.size(); ++i) {
      const auto& cable = model_.cables[i];
      auto& mean = nodes_[static_cast<std::size_t>(cable.nodes[0] % (links_ + 1))];
      mean.reaction += 2 * response_.cables[i].tension * std::sin(std::numbers::pi / rods_) / rods_;
      mean.strain += (response_.cables[i].length / model_.unstressed_length(cable) - 1) / rods_;
      mean.stiffness += model_.axial_stiffness(cable) / rods_;
    }
  }

  /// Largest distance of a node from its place on the mean rod [m].
  double asymmetry() const {
    double most = 0;
    for (int rod = 0; rod < rods_; ++rod)
      for (int k = 0; k <= links_; ++k) {
        const auto& mean = nodes_[static_cast<std::size_t>(k)];
        const Vec3 place = in_space(outward(rod, rods_), mean.x, mean.y);
        most = std::max(most, (position(rod * (links_ + 1) + k) - place).norm());
      }
    return most;
  }

  /// Trapezoidal rule over the elements of all rods.
  void add_errors(Json& entry) const {
    double squares = 0, length = 0, most = 0;
    for (const auto& beam : model_.beams) {
      const double h = (model_.nodes[beam.nodes[1]] - model_.nodes[beam.nodes[0]]).norm();
      for (const int node : beam.nodes) {
        const auto [x, y] = in_meridian(node);
        const double e = umbrella_.meridian.distance(x, y);
        squares += e * e * h / 2;
        if (std::abs(e) > std::abs(most) * (1 + 1e-6)) most = e;
      }
      length += h;
    }
    entry["rod_error_rms"] = std::sqrt(squares / length);
    entry["rod_error_max"] = most;
  }

  const rod::Umbrella& umbrella_;
  const model::Model& model_;
  const model::State& state_;
  const model::Response& response_;
  int rods_, links_;
  std::vector<NodeMeans> nodes_;
};

}  // namespace

model::Model make_rod_structure(const rod::Umbrella& umbrella, const rod::UmbrellaOptions& options,
                                const VecX& lengths, const VecX& stiffness) {
  check_cables(umbrella, stiffness);
  model::Model model;
  add_groups(model, umbrella, options, stiffness);
  const int rods = umbrella.cables.rods;
  for (int rod = 0; rod < rods; ++rod) add_rod(model, umbrella, lengths, rod, rods);
  add_parallels(model, rods, umbrella.rod.links());
  auto& support = model.supports.emplace_back();
  support.name = "roots";
  support.on = {"roots"};
  support.nodes = model.selections["roots"].nodes;
  return model;
}

Json rods_json(Context& context, const model::Response& response) {
  return RodsReport(context, response).json();
}

}  // namespace tautline::steps
