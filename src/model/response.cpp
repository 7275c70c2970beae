#include <tautline/model/response.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <tautline/element/cable.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::model {

Response evaluate_response(const Model& model, const State& state) {
  using element::Want;
  Response response;
  response.cables.reserve(model.cables.size());
  for (const auto& cable : model.cables) {
    const auto data = cable_data(model, cable);
    const auto result =
        element::evaluate_cable(data.properties, data.x_ref, gather(state, cable.nodes), Want::force);
    const double length = (model.nodes[cable.nodes[1]] + state.displacement[cable.nodes[1]] -
                           model.nodes[cable.nodes[0]] - state.displacement[cable.nodes[0]])
                              .norm();
    response.cables.push_back({length, result.tension, result.slack});
  }
  for (const auto& beam : model.beams) {
    const auto result = element::evaluate_beam(model.groups[beam.group].beam, beam_geometry(model, beam),
                                               beam_motion(state, beam), Want::force);
    response.beams.push_back(result.forces);
    response.beam_frames.push_back(result.frame);
  }
  for (const auto& membrane : model.membranes) {
    const auto result = element::evaluate_membrane(model.groups[membrane.group].membrane, membrane.prestress,
                                                   membrane_nodes(model, membrane),
                                                   gather(state, membrane.nodes), Want::force);
    response.membranes.push_back({result.principal_cauchy});
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

/// Forces below 1e-12 of the largest in the structure are what rounding leaves of zero, and are reported as
/// zero.
void clear_rounding(std::vector<GroupSummary>& summaries) {
  double largest = 0;
  const auto each = [](GroupSummary& s, const auto& action) {
    for (double* force : {&s.tension_min, &s.tension_max, &s.axial_min, &s.axial_max, &s.moment_max})
      action(*force);
  };
  for (auto& summary : summaries)
    each(summary, [&](double& force) {
      if (std::isfinite(force)) largest = std::max(largest, std::abs(force));
    });
  for (auto& summary : summaries)
    each(summary, [&](double& force) {
      if (std::abs(force) < 1e-12 * largest) force = 0;
    });
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

}  // namespace

std::map<std::string, GroupSummary> summarise_groups(const Model& model, const Response& response) {
  std::vector<GroupSummary> summaries;
  for (const auto& group : model.groups) summaries.push_back(start(group));
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    auto& s = summaries[model.cables[i].group];
    const double tension = response.cables[i].tension;
    ++s.count;
    s.slack += response.cables[i].slack ? 1 : 0;
    s.tension_min = std::min(s.tension_min, tension);
    s.tension_max = std::max(s.tension_max, tension);
    s.tension_mean += tension;
    s.tension_rms_from_target += std::pow(tension - model.groups[model.cables[i].group].target_tension, 2);
  }
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    auto& s = summaries[model.beams[i].group];
    const auto& forces = response.beams[i];
    ++s.count;
    s.axial_min = std::min(s.axial_min, forces.axial);
    s.axial_max = std::max(s.axial_max, forces.axial);
    for (int end = 0; end < 2; ++end)
      s.moment_max = std::max(s.moment_max, forces.end_moment.col(end).tail<2>().norm());
  }
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    auto& s = summaries[model.membranes[i].group];
    ++s.count;
    s.principal_min = std::min(s.principal_min, response.membranes[i].principal_cauchy[1]);
    s.principal_max = std::max(s.principal_max, response.membranes[i].principal_cauchy[0]);
  }
  clear_rounding(summaries);
  std::map<std::string, GroupSummary> result;
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    finish(summaries[i]);
    result[model.groups[i].name] = summaries[i];
  }
  return result;
}

}  // namespace tautline::model
