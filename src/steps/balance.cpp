#include "steps/balance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <tautline/model/state.hpp>

#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

Json triple(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Json vector_on_grid(const Vec3& v, double size) {
  return {on_grid(v[0], size), on_grid(v[1], size), on_grid(v[2], size)};
}

/// Force of a support and moment about its centre, with the sums of magnitudes whose rounding they carry.
struct Reaction {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_size = 0, moment_size = 0;

  void add(const Vec3& lever, const Vec3& f, const Vec3& m) {
    force += f;
    moment += lever.cross(f) + m;
    force_size += f.norm();
    moment_size += m.norm() + lever.norm() * f.norm();
  }
  /// Rounding of the larger reactions elsewhere, or of the stiffest elements, is nothing of its own.
  Json json(double largest_force, double largest_moment, double rounding, double reach) const {
    const auto shown = [](const Vec3& v, double size, double largest, double noise) {
      const bool real = size > 1e-12 * largest && v.norm() > noise;
      return real ? vector_on_grid(v, size) : triple(Vec3::Zero());
    };
    return {{"force", shown(force, force_size, largest_force, rounding)},
            {"moment", shown(moment, moment_size, largest_moment, rounding * reach)}};
  }
};

/// Sums of force and of moment about the origin.
struct Resultant {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double size = 0, moment_size = 0;  ///< sums of magnitudes

  void add(const Vec3& at, const Vec3& f, const Vec3& m) {
    const Vec3 turn = at.cross(f) + m;
    force += f;
    moment += turn;
    size += f.norm();
    moment_size += turn.norm();
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
  double farthest = 0, most = 0;
  for (const auto& u : system.state().displacement) farthest = std::max(farthest, u.norm());
  for (const auto& r : system.state().rotation) most = std::max(most, Eigen::AngleAxisd(r).angle());
  for (const auto& name : names) {
    const auto nodes = system.model().nodes_of({name});
    Vec3 u = Vec3::Zero(), r = Vec3::Zero();
    for (const int node : nodes) {
      const Eigen::AngleAxisd turn(system.state().rotation[node]);
      u += system.state().displacement[node] / static_cast<double>(nodes.size());
      r += turn.angle() * turn.axis() / static_cast<double>(nodes.size());
    }
    result[name] = {{"displacement", vector_on_grid(u, farthest)}, {"rotation", vector_on_grid(r, most)}};
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
  double force = 0, moment = 0;
  for (const auto& [name, sum] : list) {
    force = std::max(force, sum.force_size);
    moment = std::max(moment, sum.moment_size);
  }
  Json result = Json::object();
  for (const auto& [name, sum] : list)
    result[name] = sum.json(force, std::max(moment, force * system.size()), system.rounding_force_of_lines(),
                            system.size());
  return result;
}

Json balance_json(const assembly::System& system, const assembly::System::NodalForces& reactions) {
  const auto& model = system.model();
  if (!model.constraints.empty() || !model.cyclic_pairs.empty()) return nullptr;
  const auto applied = system.applied(), springs = system.ground_springs();
  const auto positions = model::positions(model, system.state());
  Resultant all, loads;
  double reach = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    all.add(positions[i], reactions.force[i], reactions.moment[i]);
    all.add(positions[i], springs.force[i], springs.moment[i]);
    all.add(positions[i], applied.force[i], applied.moment[i]);
    loads.add(positions[i], applied.force[i], applied.moment[i]);
    reach = std::max(reach, positions[i].norm());
  }
  const double rounding = system.rounding_force();
  const auto part = [](double value, double of, double floor) {
    return above_rounding(value > floor ? value / of : 0, 1e-9);
  };
  return {{"applied_force", triple(loads.force)},
          {"force", part(all.force.norm(), all.size + all.moment_size / reach, rounding)},
          {"moment", part(all.moment.norm(), all.moment_size + all.size * reach, rounding * reach)}};
}

}  // namespace tautline::steps
