#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tautline/model/doubts.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/names.hpp>

#include "model/detail/doubt_limits.hpp"

namespace tautline::model {

namespace {

using namespace detail;

/// Elements of a group beyond a limit: how many, and the worst.
struct Beyond {
  std::size_t count = 0, worst = 0;
  double value = 0;

  void add(std::size_t element, double v, double limit) {
    if (!(v > limit)) return;
    ++count;
    if (v <= value) return;
    value = v;
    worst = element;
  }
};

std::string and_others(std::size_t count) {
  if (count <= 1) return "";
  return fmt::format(" (the worst of {})", count);
}

std::vector<double> facet_strains(const Model& model, const Response& response) {
  std::vector<double> strains;
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    const auto& section = model.groups[model.membranes[i].group].membrane;
    const double stiffness = section.orthotropic()
                                 ? std::min(section.tension_stiffness, section.tension_stiffness_2)
                                 : section.tension_stiffness;
    strains.push_back(response.membranes[i].principal_cauchy.cwiseAbs().maxCoeff() / stiffness);
  }
  for (std::size_t i = 0; i < model.shells.size(); ++i) {
    const auto& section = model.groups[model.shells[i].group].shell;
    strains.push_back(principal_values(response.shells[i].membrane).cwiseAbs().maxCoeff() /
                      (section.young_modulus * section.thickness));
  }
  return strains;
}

/// Of each beam, how far one end is turned against the other [rad].
std::vector<double> turns_within(const Model& model, const Response& response) {
  std::vector<double> turns;
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const auto& beam = model.beams[i];
    const auto section = beam_section(model, beam);
    const auto& forces = response.beams[i];
    const double length = (model.nodes[beam.nodes[1]] - model.nodes[beam.nodes[0]]).norm();
    const auto bent = [&](int axis, double stiffness) {
      return (forces.end_moment(axis, 1) - forces.end_moment(axis, 0)) / (2 * stiffness);
    };
    turns.push_back(length * Vec3(forces.torque / section.torsion_stiffness,
                                  bent(1, section.bending_stiffness_2), bent(2, section.bending_stiffness_3))
                                 .norm());
  }
  return turns;
}

}  // namespace

LineStrains line_strains(const Model& model, const Response& response) {
  LineStrains strains;
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    strains.cables.push_back(std::abs(response.cables[i].tension) / model.axial_stiffness(model.cables[i]));
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const auto section = beam_section(model, model.beams[i]);
    const auto& forces = response.beams[i];
    const double axial = std::abs(forces.axial) / section.axial_stiffness;
    double bending = 0;
    for (int end = 0; end < 2; ++end)
      bending = std::max({bending,
                          std::abs(forces.end_moment(1, end)) /
                              std::sqrt(section.bending_stiffness_2 * section.axial_stiffness),
                          std::abs(forces.end_moment(2, end)) /
                              std::sqrt(section.bending_stiffness_3 * section.axial_stiffness)});
    strains.beams.push_back(std::max(axial, bending));
  }
  return strains;
}

std::vector<double> euler_ratios(const Model& model, const Response& response) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    const auto& beam = model.beams[i];
    const auto section = beam_section(model, beam);
    const double length = (model.nodes[beam.nodes[1]] - model.nodes[beam.nodes[0]]).norm();
    const double euler = std::pow(std::numbers::pi / length, 2) *
                         std::min(section.bending_stiffness_2, section.bending_stiffness_3);
    ratios.push_back(std::max(0.0, -response.beams[i].axial / euler));
  }
  return ratios;
}

std::vector<Doubt> state_doubts(const Model& model, const Response& response) {
  std::vector<Doubt> doubts;
  std::vector<Beyond> strained(model.groups.size()), pressed(model.groups.size()),
      turned(model.groups.size());
  const auto lines = line_strains(model, response);
  const auto ratios = euler_ratios(model, response), turns = turns_within(model, response);
  const auto facets = facet_strains(model, response);
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    strained[model.cables[i].group].add(i, lines.cables[i], largest_strain);
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    strained[model.beams[i].group].add(i, lines.beams[i], largest_strain);
    pressed[model.beams[i].group].add(i, ratios[i], 1);
    turned[model.beams[i].group].add(i, turns[i], largest_turn);
  }
  for (std::size_t i = 0; i < model.membranes.size(); ++i)
    strained[model.membranes[i].group].add(i, facets[i], largest_strain);
  for (std::size_t i = 0; i < model.shells.size(); ++i)
    strained[model.shells[i].group].add(i, facets[model.membranes.size() + i], largest_strain);
  const auto name = [&](std::size_t group, std::size_t element) {
    const auto kind = model.groups[group].kind;
    if (is_cable_like(kind)) return cable_name(model, element);
    if (kind == ElementKind::beam) return beam_name(model, element);
    return element_name(model, kind == ElementKind::membrane ? "membrane" : "shell", element,
                        static_cast<int>(group));
  };
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const std::string where = fmt::format("group \"{}\"", model.groups[g].name);
    if (strained[g].count > 0)
      doubts.push_back(
          {"strain",
           fmt::format("{} is strained by {:.3g} %{}, beyond the small strains of its law and of any "
                       "structure: compare load and stiffness, and their units",
                       name(g, strained[g].worst), 100 * strained[g].value, and_others(strained[g].count)),
           where});
    if (pressed[g].count > 0)
      doubts.push_back(
          {"member_buckling",
           fmt::format("{} carries {:.3g} times the Euler load of its own length between hinged "
                       "ends{}, and cannot bow out within one element: divide the group "
                       "(group_subdivisions of a mesh step), or take a stiffer section",
                       name(g, pressed[g].worst), pressed[g].value, and_others(pressed[g].count)),
           where});
    if (turned[g].count > 0)
      doubts.push_back(
          {"large_turn",
           fmt::format(
               "{} turns by {:.3g} rad from end to end{}: one element follows some tenths of a radian, "
               "and more than half a turn looks to it like less. Divide the group "
               "(group_subdivisions of a mesh step)",
               name(g, turned[g].worst), turned[g].value, and_others(turned[g].count)),
           where});
  }
  return doubts;
}

}  // namespace tautline::model
