#include <tautline/model/response.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <tautline/element/cable.hpp>
#include <tautline/model/beam_ends.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::model {

namespace {

using element::Want;

CableResult cable_result(const Model& model, const State& state, const Cable& cable) {
  const auto u = displacements<2>(state, cable.nodes);
  if (model.groups[cable.group].kind == ElementKind::catenary) {
    const auto result = element::evaluate_catenary(catenary_properties(model, cable), model.acceleration,
                                                   reference_nodes<2>(model, cable.nodes), u, Want::force);
    const double tension = std::max(result.tension_start, result.tension_end);
    return {result.length, tension, tension == 0};
  }
  const auto data = cable_data(model, cable);
  const auto result = element::evaluate_cable(data.properties, data.x_ref, u, Want::force);
  const double length = (data.x_ref.col(1) - data.x_ref.col(0) + u.tail<3>() - u.head<3>()).norm();
  return {length, result.tension, result.slack};
}

/// What the nodes carry for a load along the beam is no force in its sections: the end forces are those of
/// the element less its share of that load.
void take_off_line_load(element::BeamForces& forces, const Mat3& frame, const Model& model,
                        const Beam& beam) {
  if (beam.line_load.isZero(0)) return;
  const Vec3 way = model.nodes[beam.nodes[1]] - model.nodes[beam.nodes[0]];
  const Vec3 half = frame.transpose() * beam.line_load * (way.norm() / 2);
  const Vec3 end_moment = frame.transpose() * way.cross(beam.line_load) * (way.norm() / 12);
  forces.axial -= half[0];
  forces.shear -= half.tail<2>();
  forces.end_moment.col(0) -= end_moment;
  forces.end_moment.col(1) += end_moment;
}

template <int N>
MembraneResult membrane_result(const Model& model, const State& state, const Membrane& membrane) {
  const auto result = element::evaluate_membrane<N>(membrane_law<N>(model, membrane),
                                                    reference_nodes<N>(model, membrane.nodes),
                                                    displacements<N>(state, membrane.nodes), Want::force);
  return {result.principal_cauchy, result.state};
}

template <int N>
element::ShellForces shell_result(const Model& model, const State& state, const Shell& shell) {
  return element::evaluate_shell<N>(model.groups[shell.group].shell, shell_geometry<N>(model, shell),
                                    shell_motion<N>(state, shell), Want::force)
      .forces;
}

}  // namespace

bool only_pulls(const Model& model, const Cable& cable) {
  const auto kind = model.groups[cable.group].kind;
  return kind == ElementKind::cable || kind == ElementKind::catenary;
}

bool is_slack(const Model& model, const State& state, const Cable& cable) {
  constexpr double nearly_none = 1e-9;
  return only_pulls(model, cable) &&
         cable_result(model, state, cable).tension <= nearly_none * model.axial_stiffness(cable);
}

Response evaluate_response(const Model& model, const State& state) {
  Response response;
  response.cables.reserve(model.cables.size());
  for (const auto& cable : model.cables) response.cables.push_back(cable_result(model, state, cable));
  for (const auto& beam : model.beams) {
    const auto result = element::evaluate_beam(beam_section(model, beam), beam_geometry(model, beam),
                                               beam_motion(state, beam), Want::force);
    response.beams.push_back(result.forces);
    take_off_line_load(response.beams.back(), result.frame, model, beam);
    response.beam_frames.push_back(result.frame);
  }
  for (const auto& membrane : model.membranes)
    response.membranes.push_back(membrane.nodes.size() == 3 ? membrane_result<3>(model, state, membrane)
                                                            : membrane_result<4>(model, state, membrane));
  for (const auto& shell : model.shells)
    response.shells.push_back(shell.nodes.size() == 3 ? shell_result<3>(model, state, shell)
                                                      : shell_result<4>(model, state, shell));
  for (const auto& spring : model.springs) {
    const auto result = element::evaluate_spring(model.groups[spring.group].spring,
                                                 spring_motion(state, spring), Want::force);
    response.springs.push_back({result.spring_force, result.spring_moment});
  }
  return response;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

GroupSummary start(const Group& group) {
  GroupSummary summary;
  summary.kind = group.kind;
  summary.has_target = group.kind == ElementKind::cable && group.target_tension > 0;
  summary.tension_min = summary.axial_min = summary.principal_min = infinity;
  summary.tension_max = summary.axial_max = summary.principal_max = -infinity;
  return summary;
}

void finish(GroupSummary& summary) {
  if (summary.count == 0) {
    summary.tension_min = summary.tension_max = summary.axial_min = summary.axial_max = 0;
    summary.principal_min = summary.principal_max = 0;
  } else {
    summary.tension_mean /= summary.count;
    summary.tension_rms_from_target = std::sqrt(summary.tension_rms_from_target / summary.count);
  }
}

void add(GroupSummary& s, const CableResult& cable, double target) {
  s.slack += cable.slack ? 1 : 0;
  s.axial_min = s.tension_min = std::min(s.tension_min, cable.tension);
  s.axial_max = s.tension_max = std::max(s.tension_max, cable.tension);
  s.tension_mean += cable.tension;
  s.tension_rms_from_target += std::pow(cable.tension - target, 2);
}

void add(GroupSummary& s, const element::BeamForces& beam, double axial_start) {
  s.axial_min = std::min({s.axial_min, beam.axial, axial_start});
  s.axial_max = std::max({s.axial_max, beam.axial, axial_start});
  for (int end = 0; end < 2; ++end)
    s.moment_max = std::max(s.moment_max, beam.end_moment.col(end).tail<2>().norm());
}

void add(GroupSummary& s, const MembraneResult& membrane) {
  s.principal_min = std::min(s.principal_min, membrane.principal_cauchy[1]);
  s.principal_max = std::max(s.principal_max, membrane.principal_cauchy[0]);
  s.wrinkled += membrane.state == element::MembraneState::wrinkled ? 1 : 0;
  s.slack += membrane.state == element::MembraneState::slack ? 1 : 0;
}

void add(GroupSummary& s, const element::ShellForces& shell) {
  const auto n = principal_values(shell.membrane), m = principal_values(shell.moment);
  s.principal_min = std::min(s.principal_min, n[1]);
  s.principal_max = std::max(s.principal_max, n[0]);
  s.moment_max = std::max(s.moment_max, m.cwiseAbs().maxCoeff());
}

void add(GroupSummary& s, const SpringResult& spring) {
  s.force_max = std::max(s.force_max, spring.force.norm());
  s.moment_max = std::max(s.moment_max, spring.moment.norm());
}

}  // namespace

Vec3 first_end_force(const Model& model, const Response& response, std::size_t beam) {
  const auto& forces = response.beams[beam];
  const Vec3 end(forces.axial, forces.shear[0], forces.shear[1]);
  const auto& element = model.beams[beam];
  if (element.line_load.isZero(0)) return end;
  const double length = (model.nodes[element.nodes[1]] - model.nodes[element.nodes[0]]).norm();
  return end + response.beam_frames[beam].transpose() * element.line_load * length;
}

Vec<2> principal_values(const Vec3& n) {
  const double mean = (n[0] + n[1]) / 2, radius = std::hypot((n[0] - n[1]) / 2, n[2]);
  return {mean + radius, mean - radius};
}

std::map<std::string, GroupSummary> summarise_groups(const Model& model, const State& state,
                                                     const Response& response) {
  std::vector<GroupSummary> summaries;
  for (const auto& group : model.groups) summaries.push_back(start(group));
  const auto add_all = [&](const auto& elements, const auto& results) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      auto& summary = summaries[elements[i].group];
      ++summary.count;
      if constexpr (std::is_same_v<std::decay_t<decltype(results[i])>, CableResult>)
        add(summary, results[i], model.groups[elements[i].group].target_tension);
      else if constexpr (std::is_same_v<std::decay_t<decltype(results[i])>, element::BeamForces>)
        add(summary, results[i], first_end_force(model, response, i)[0]);
      else
        add(summary, results[i]);
    }
  };
  add_all(model.cables, response.cables);
  add_all(model.beams, response.beams);
  add_all(model.membranes, response.membranes);
  add_all(model.shells, response.shells);
  add_all(model.springs, response.springs);
  for (const auto& point : model.masses) ++summaries[point.group].count;
  for (const auto& link : model.links)
    if (link.group >= 0 && model.groups[link.group].kind == ElementKind::link) ++summaries[link.group].count;
  const auto rounding = rounding_by_group(model, state);
  std::map<std::string, GroupSummary> result;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    finish(summaries[i]);
    summaries[i].rounding = rounding[i];
    result[model.groups[i].name] = summaries[i];
  }
  return result;
}

}  // namespace tautline::model
