#include "steps/fields.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

using output::Field;

Field displacement_field(const model::State& state) {
  Field field{"displacement [m]", 3, {}};
  for (const auto& u : state.displacement) field.values.insert(field.values.end(), u.begin(), u.end());
  return field;
}

/// NaN away from the cloth, so that ParaView leaves it blank.
Field deviation_field(Context& context) {
  const auto sample = surface_sample(context);
  Field field{"surface deviation [m]", 1, std::vector<double>(sample.positions.size(), std::nan(""))};
  for (const int node : sample.surface_nodes)
    field.values[node] = reflector::deviation(*context.surface, sample.positions[node]);
  return field;
}

/// Cell arrays run over cables, beams, membranes, shells; entries that do not apply are zero.
class CellArrays {
 public:
  CellArrays(const model::Model& model, const model::Response& response)
      : model_(model), response_(response) {}

  Field scalar(const std::string& name, double (*cable)(const model::CableResult&),
               double (*beam)(const element::BeamForces&), double (*membrane)(const model::MembraneResult&),
               double (*shell)(const element::ShellForces&) = nullptr) const {
    Field field{name, 1, {}};
    for (const auto& r : response_.cables) field.values.push_back(cable ? cable(r) : 0);
    for (const auto& r : response_.beams) field.values.push_back(beam ? beam(r) : 0);
    for (const auto& r : response_.membranes) field.values.push_back(membrane ? membrane(r) : 0);
    for (const auto& r : response_.shells) field.values.push_back(shell ? shell(r) : 0);
    return field;
  }

  /// A beam's axis `k`, or its moments at end `k`.
  template <class Pick>
  Field beam_vector(const std::string& name, const Pick& pick) const {
    Field field{name, 3, std::vector<double>(3 * response_.cables.size(), 0.0)};
    for (std::size_t i = 0; i < response_.beams.size(); ++i) {
      const Vec3 v = pick(i);
      field.values.insert(field.values.end(), v.begin(), v.end());
    }
    field.values.resize(field.values.size() + 3 * (response_.membranes.size() + response_.shells.size()),
                        0.0);
    return field;
  }

  Field group() const {
    Field field{"group", 1, {}};
    for (const auto& e : model_.cables) field.values.push_back(e.group);
    for (const auto& e : model_.beams) field.values.push_back(e.group);
    for (const auto& e : model_.membranes) field.values.push_back(e.group);
    for (const auto& e : model_.shells) field.values.push_back(e.group);
    return field;
  }

 private:
  const model::Model& model_;
  const model::Response& response_;
};

}  // namespace

output::FieldGrid field_grid(Context& context, const model::Response& response) {
  const auto& model = context.system().model();
  const auto& state = context.system().state();
  output::FieldGrid grid;
  grid.points = model.nodes;
  for (const auto& cable : model.cables) grid.lines.push_back(cable.nodes);
  for (const auto& beam : model.beams) grid.lines.push_back(beam.nodes);
  for (const auto& membrane : model.membranes) grid.facets.push_back(membrane.nodes);
  for (const auto& shell : model.shells) grid.facets.push_back(shell.nodes);
  grid.point_fields.push_back(displacement_field(state));
  if (context.surface) grid.point_fields.push_back(deviation_field(context));
  const CellArrays arrays(model, response);
  using model::CableResult, model::MembraneResult, element::BeamForces, element::ShellForces;
  auto& out = grid.cell_fields;
  out.push_back(arrays.group());
  out.push_back(arrays.scalar(
      "tension [N]", [](const CableResult& r) { return r.tension; }, nullptr, nullptr));
  out.push_back(arrays.scalar(
      "slack", [](const CableResult& r) { return r.slack ? 1.0 : 0.0; }, nullptr, nullptr));
  out.push_back(arrays.scalar(
      "axial force [N]", nullptr, [](const BeamForces& f) { return f.axial; }, nullptr));
  out.push_back(arrays.scalar(
      "shear 2 [N]", nullptr, [](const BeamForces& f) { return f.shear[0]; }, nullptr));
  out.push_back(arrays.scalar(
      "shear 3 [N]", nullptr, [](const BeamForces& f) { return f.shear[1]; }, nullptr));
  out.push_back(arrays.beam_vector("end moments 1 [N m]",
                                   [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(0)); }));
  out.push_back(arrays.beam_vector("end moments 2 [N m]",
                                   [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(1)); }));
  for (int axis = 0; axis < 3; ++axis)
    out.push_back(arrays.beam_vector(fmt::format("beam axis {}", axis + 1),
                                     [&](std::size_t i) { return Vec3(response.beam_frames[i].col(axis)); }));
  out.push_back(arrays.scalar(
      "principal resultant 1 [N/m]", nullptr, nullptr,
      [](const MembraneResult& r) { return r.principal_cauchy[0]; },
      [](const ShellForces& f) { return model::principal_values(f.membrane)[0]; }));
  out.push_back(arrays.scalar(
      "principal resultant 2 [N/m]", nullptr, nullptr,
      [](const MembraneResult& r) { return r.principal_cauchy[1]; },
      [](const ShellForces& f) { return model::principal_values(f.membrane)[1]; }));
  if (std::any_of(model.groups.begin(), model.groups.end(),
                  [](const model::Group& g) { return g.membrane.wrinkling; }))
    out.push_back(arrays.scalar("wrinkled (1) or slack (2)", nullptr, nullptr,
                                [](const MembraneResult& r) { return static_cast<double>(r.state); }));
  if (!model.shells.empty()) {
    out.push_back(arrays.scalar("principal moment 1 [N]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return model::principal_values(f.moment)[0]; }));
    out.push_back(arrays.scalar("principal moment 2 [N]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return model::principal_values(f.moment)[1]; }));
    out.push_back(arrays.scalar("transverse shear [N/m]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return f.shear.norm(); }));
  }
  return grid;
}

}  // namespace tautline::steps
