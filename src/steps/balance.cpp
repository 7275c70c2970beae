#include "steps/balance.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tautline/model/state.hpp>

namespace tautline::steps {

namespace {

Json triple(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

/// Force of a support and moment about its centre.
struct Reaction {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();

  void add(const Vec3& lever, const Vec3& f, const Vec3& m) {
    force += f;
    moment += lever.cross(f) + m;
  }
  Json json() const { return {{"force", triple(force)}, {"moment", triple(moment)}}; }
};

/// Sum of force and of moment about the origin, with the sums of magnitudes.
struct Resultant {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double forces = 0, moments = 0;

  void add(const Points& at, const assembly::System::NodalForces& nodal) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      force += nodal.force[i];
      moment += at[i].cross(nodal.force[i]) + nodal.moment[i];
      forces += nodal.force[i].norm();
      moments += nodal.moment[i].norm();
    }
  }
};

/// The part of a reaction along the directions that a support holds and no support before it held.
class Claims {
 public:
  Vec3 take(const Mat3& axes, const bool* fixed, const Vec3& reaction) {
    Vec3 part = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      if (!fixed[c]) continue;
      Vec3 direction = axes.col(c);
      for (const Vec3& known : taken_) direction -= known * known.dot(direction);
      if (direction.norm() < 1e-8) continue;
      taken_.push_back(direction.normalized());
      part += taken_.back() * taken_.back().dot(reaction);
    }
    return part;
  }

 private:
  std::vector<Vec3> taken_;
};

}  // namespace

Json monitors_json(const assembly::System& system, const std::vector<std::string>& names) {
  Json result = Json::object();
  for (const auto& name : names) {
    const auto nodes = system.model().nodes_of({name});
    Vec3 u = Vec3::Zero(), r = Vec3::Zero();
    for (const int node : nodes) {
      const Eigen::AngleAxisd turn(system.state().rotation[node]);
      u += system.state().displacement[node] / static_cast<double>(nodes.size());
      r += turn.angle() * turn.axis() / static_cast<double>(nodes.size());
    }
    result[name] = {{"displacement", triple(u)}, {"rotation", triple(r)}};
  }
  return result;
}

Json reactions_json(const assembly::System& system, const assembly::Boundary& boundary,
                    const assembly::System::NodalForces& reactions) {
  std::map<int, std::array<Claims, 2>> claims;  // by node: of forces, of moments
  std::vector<std::pair<std::string, Reaction>> list;
  const auto positions = model::positions(system.model(), system.state());
  const auto centre_of = [&](const auto& nodes) {
    Vec3 sum = Vec3::Zero();
    for (const int node : nodes) sum += positions[node];
    return Vec3(sum / std::max<double>(1, static_cast<double>(nodes.size())));
  };
  for (const auto& support : boundary.supports) {
    Reaction sum;
    const Vec3 centre = centre_of(support.nodes);
    for (const int node : support.nodes) {
      auto& [of_force, of_moment] = claims[node];
      const Mat3 axes = system.kinematics().reaction_axes(node) * support.axes;
      sum.add(positions[node] - centre,
              of_force.take(support.axes, support.fixed.data(), reactions.force[node]),
              of_moment.take(axes, support.fixed.data() + 3, reactions.moment[node]));
    }
    list.emplace_back(support.name, sum);
  }
  const auto& model = system.model();
  const auto ground = system.ground_springs();
  std::map<std::string, std::set<int>> sprung;
  for (const auto& spring : model.springs)
    if (spring.grounded()) sprung[model.groups[spring.group].name].insert(spring.nodes[0]);
  for (const auto& [name, nodes] : sprung) {
    Reaction sum;
    const Vec3 centre = centre_of(nodes);
    for (const int node : nodes) sum.add(positions[node] - centre, ground.force[node], ground.moment[node]);
    list.emplace_back(name, sum);
  }
  Json result = Json::object();
  for (const auto& [name, sum] : list) result[name] = sum.json();
  return result;
}

Json balance_json(const assembly::System& system) {
  const auto applied = system.applied();
  const auto positions = model::positions(system.model(), system.state());
  Resultant loads, all;
  loads.add(positions, applied);
  all.add(positions, applied);
  all.add(positions, system.reactions());
  all.add(positions, system.ground_springs());
  all.add(positions, system.constraint_forces());
  double reach = 0;
  for (const auto& position : positions) reach = std::max(reach, position.norm());
  if (!(reach > 0)) reach = 1;
  const auto rounding = system.rounding();
  const double size = all.forces + all.moments / reach;
  const auto part = [size](double value) { return size > 0 ? value / size : 0; };
  return {{"applied_force", triple(loads.force)},
          {"size", size},
          {"force", part(all.force.norm())},
          {"moment", part(all.moment.norm() / reach)},
          {"rounding", part(rounding.force + rounding.moment / reach)}};
}

std::string imbalance(const Json& balance) {
  constexpr double most = 1e-6, times_rounding = 10;
  const double force = balance["force"], moment = balance["moment"], rounding = balance["rounding"];
  const double miss = std::max(force, moment);
  if (miss <= std::max(most, times_rounding * rounding)) return {};
  return fmt::format(
      "loads and reactions miss each other by {:.2e} of the {} of {:.4g} N that they sum up to, which is "
      "more "
      "than {:g} and more than {:g} times the rounding level {:.1e}",
      miss, moment > force ? "moment" : "force", balance["size"].get<double>(), most, times_rounding,
      rounding);
}

}  // namespace tautline::steps
