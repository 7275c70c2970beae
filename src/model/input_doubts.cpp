#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/model/doubts.hpp>

#include "model/detail/doubt_limits.hpp"

namespace tautline::model {

namespace {

using namespace detail;

bool within(double value, double least, double most) {
  return value >= least && value <= most;
}

/// Speed of sound in what a group is made of [m/s]; none without mass or stiffness.
std::optional<double> speed_of_sound(const Group& group) {
  double stiffness = 0, mass = 0;
  if (is_cable_like(group.kind)) {
    stiffness = group.cable.axial_stiffness;
    mass = group.cable.mass_per_length;
  } else if (group.kind == ElementKind::beam) {
    stiffness = group.beam.axial_stiffness;
    mass = group.beam.mass_per_length;
  } else if (group.kind == ElementKind::membrane) {
    stiffness = group.membrane.tension_stiffness;
    mass = group.membrane.mass_per_area;
  } else if (group.kind == ElementKind::shell) {
    stiffness = group.shell.young_modulus;
    mass = group.shell.density;
  }
  if (!(stiffness > 0) || !(mass > 0)) return std::nullopt;
  return std::sqrt(stiffness / mass);
}

/// Whether the groups are made of solids if lengths are metres: more of them are than are not; where nothing
/// has mass, whether a material has the modulus of one.
bool in_metres(const Model& model, const Stock& stock) {
  int solid = 0, other = 0;
  for (const auto& group : model.groups)
    if (const auto speed = speed_of_sound(group))
      ++(within(*speed, usual_sound.least, usual_sound.most) ? solid : other);
  if (solid + other > 0) return solid > other;
  return std::any_of(stock.materials.begin(), stock.materials.end(), [](const auto& entry) {
    return within(entry.second.young_modulus, usual_modulus.least, usual_modulus.most);
  });
}

class InputCheck {
 public:
  InputCheck(const Model& model, const Stock& stock) : model_(model), stock_(stock) {}

  std::vector<Doubt> run() {
    for (const auto& [name, material] : stock_.materials) check_material(name, material);
    check_initial_strains();
    check_turns();
    if (!in_metres(model_, stock_)) return std::move(doubts_);
    for (const auto& [name, section] : stock_.sections) check_section(name, section);
    check_size();
    check_accelerations();
    return std::move(doubts_);
  }

 private:
  void add(const char* code, const std::string& where, std::string message) {
    doubts_.push_back({code, std::move(message), where});
  }

  /// One figure alone may mean anything; two that belong to one solid tell of the unit of one of them.
  void check_material(const std::string& name, const MaterialOptions& m) {
    const std::string where = fmt::format("material \"{}\"", name);
    if (m.young_modulus > largest_modulus)
      add("modulus", where,
          fmt::format("young_modulus {:.3g} Pa is far above that of any solid (diamond: 1.2e12 Pa)",
                      m.young_modulus));
    if (m.density > largest_density)
      add("density", where,
          fmt::format("density {:.3g} kg/m^3 is far above that of any solid (osmium: 22 600 kg/m^3)",
                      m.density));
    if (std::abs(m.thermal_expansion) > largest_expansion)
      add("thermal_expansion", where,
          fmt::format("thermal_expansion {:.3g} per K: solids have less than {:g}; steel has 1.2e-5",
                      m.thermal_expansion, largest_expansion));
    if (!(m.young_modulus > 0) || !(m.density > 0) || m.density > largest_density ||
        m.young_modulus > largest_modulus)
      return;
    const double speed = std::sqrt(m.young_modulus / m.density);
    if (speed < possible_sound.least && within(m.density, usual_density.least, usual_density.most))
      add("modulus", where,
          fmt::format("young_modulus {:.3g} Pa is far too small for a solid of {:.3g} kg/m^3 (sound would "
                      "travel in it at {:.2g} m/s): is it in MPa or GPa? Pa are expected",
                      m.young_modulus, m.density, speed));
    if (speed > possible_sound.most && within(m.young_modulus, usual_modulus.least, usual_modulus.most))
      add("density", where,
          fmt::format(
              "density {:.3g} kg/m^3 is far too small for a solid of {:.3g} Pa (sound would travel in "
              "it at {:.2g} m/s): is it in t/mm^3 or g/cm^3? kg/m^3 are expected",
              m.density, m.young_modulus, speed));
  }

  void check_initial_strains() {
    std::vector<double> largest(model_.groups.size(), 0);
    for (const auto& cable : model_.cables)
      if (model_.groups[cable.group].kind != ElementKind::catenary)
        largest[cable.group] = std::max(largest[cable.group], cable.initial_strain);
    for (const auto& membrane : model_.membranes) {
      const auto& section = model_.groups[membrane.group].membrane;
      const double stiffness = section.orthotropic()
                                   ? std::min(section.tension_stiffness, section.tension_stiffness_2)
                                   : section.tension_stiffness;
      largest[membrane.group] =
          std::max(largest[membrane.group], membrane.prestress.head<2>().maxCoeff() / stiffness);
    }
    for (std::size_t i = 0; i < largest.size(); ++i)
      if (largest[i] > largest_strain)
        add("strain", fmt::format("group \"{}\"", model_.groups[i].name),
            fmt::format(
                "its initial tension strains it by {:.3g} %, which no structure bears: compare tension "
                "and stiffness, and their units",
                100 * largest[i]));
  }

  void too_large(const std::string& name, const char* what, double size, double most) {
    if (size > most)
      add("section_size", fmt::format("section \"{}\"", name),
          fmt::format("{} is {:.3g} m: is it in millimetres? Metres are expected", what, size));
  }

  void check_section(const std::string& name, const SectionOptions& options) {
    std::visit(
        [&](const auto& s) {
          if constexpr (requires { s.axial_stiffness, s.area, s.diameter; }) {
            if (s.diameter) too_large(name, "the diameter", *s.diameter, largest_cable);
            if (s.area && *s.area > 0)
              too_large(name, "the diameter of its area", std::sqrt(4 * *s.area / std::numbers::pi),
                        largest_cable);
          } else if constexpr (requires { s.diameter_start; }) {
            too_large(name, "the diameter", std::max(s.diameter_start, s.diameter_end), largest_beam);
          } else if constexpr (requires { s.diameter; }) {
            too_large(name, "the diameter", s.diameter, largest_beam);
          } else if constexpr (requires { s.side; }) {
            too_large(name, "the side", s.side, largest_beam);
          } else if constexpr (requires { s.height; }) {
            too_large(name, "the height", std::max(s.width, s.height), largest_beam);
          } else if constexpr (std::is_same_v<std::decay_t<decltype(s)>, ShellSectionOptions>) {
            too_large(name, "the thickness", s.thickness, largest_wall);
          } else if constexpr (std::is_same_v<std::decay_t<decltype(s)>, MembraneSectionOptions>) {
            too_large(name, "the thickness", s.thickness.value_or(0), largest_cloth);
          }
        },
        options);
  }

  void check_size() {
    if (model_.nodes.empty()) return;
    Vec3 low = model_.nodes.front(), high = low;
    for (const auto& x : model_.nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    if (const double size = (high - low).norm(); size > largest_structure)
      add("size", "model",
          fmt::format("the structure is {:.4g} km across: are its coordinates in millimetres? Metres are "
                      "expected",
                      1e-3 * size));
  }

  /// More than half a turn of one end of an element against the other looks like less.
  void check_turns() {
    const double most = std::numbers::pi * static_cast<double>(model_.beams.size());
    for (const auto& load : model_.loads)
      if (const double size = load.rotation ? load.rotation->norm() : 0; most > 0 && size > most)
        add("large_turn", fmt::format("load \"{}\"", load.name),
            fmt::format(
                "turns a support by {:.4g} rad, more than half a turn for each of the {} beam elements: if "
                "the rest is held, divide the beams (group_subdivisions of a mesh step), else more "
                "than half a turn in one looks like less",
                size, model_.beams.size()));
  }

  void check_accelerations() {
    for (const auto& load : model_.loads)
      if (const double size = load.acceleration.norm(); size > largest_acceleration)
        add("acceleration", fmt::format("load \"{}\"", load.name),
            fmt::format("the acceleration is {:.4g} m/s^2, {:.3g} times that of gravity: is it in mm/s^2?",
                        size, size / 9.81));
  }

  const Model& model_;
  const Stock& stock_;
  std::vector<Doubt> doubts_;
};

/// Least and largest change of temperature that a load brings to the nodes of a group.
std::array<double, 2> changes(const Model& model, const Load& load, const std::string& group) {
  std::array range{load.temperature_change, load.temperature_change};
  if (!load.temperature_field) return range;
  std::optional<std::array<double, 2>> found;
  for (const int node : model.nodes_of({group})) {
    const double value = load.temperature_field(model.nodes[node]);
    if (!found) found = {value, value};
    (*found)[0] = std::min((*found)[0], value);
    (*found)[1] = std::max((*found)[1], value);
  }
  if (found) range = {range[0] + (*found)[0], range[1] + (*found)[1]};
  return range;
}

}  // namespace

std::vector<Doubt> input_doubts(const Model& model, const Stock& stock) {
  return InputCheck(model, stock).run();
}

std::vector<Doubt> temperature_doubts(const Model& model, const std::vector<std::string>& loads) {
  std::vector<Doubt> doubts;
  for (const auto& group : model.groups) {
    double least = 0, most = 0;
    std::vector<std::string> by;
    for (const auto& load : model.loads) {
      if (!load.heats() || std::find(loads.begin(), loads.end(), load.name) == loads.end() ||
          std::find(load.on.begin(), load.on.end(), group.name) == load.on.end())
        continue;
      const auto [low, high] = changes(model, load, group.name);
      least += low;
      most += high;
      if (by.empty() || by.back() != load.name) by.push_back(load.name);
    }
    const std::string where = fmt::format("load \"{}\"", join(by, "\", \""));
    if (least < lowest_cooling)
      doubts.push_back(
          {"temperature",
           fmt::format("group \"{}\" is cooled by {:.4g} K: below absolute zero, if it was at 20 "
                       "degrees Celsius before",
                       group.name, -least),
           where});
    if (most > highest_heating)
      doubts.push_back({"temperature",
                        fmt::format("group \"{}\" is heated by {:.4g} K, at which every solid has melted",
                                    group.name, most),
                        where});
  }
  return doubts;
}

}  // namespace tautline::model
