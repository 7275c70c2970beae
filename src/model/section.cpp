#include <tautline/model/section.hpp>

#include <cmath>
#include <numbers>

#include <tautline/core/error.hpp>

namespace tautline::model {

namespace {

using std::numbers::pi;

/// Geometry of a solid or hollow section.
struct Shape {
  double area, inertia_2, inertia_3, torsion, shear_factor_2, shear_factor_3;
};

element::BeamSection beam_section(const Shape& shape, const MaterialOptions& material, bool shear_flexible) {
  const double e = material.young_modulus, g = e / (2 * (1 + material.poisson_ratio)), rho = material.density;
  element::BeamSection section;
  section.axial_stiffness = e * shape.area;
  section.bending_stiffness_2 = e * shape.inertia_2;
  section.bending_stiffness_3 = e * shape.inertia_3;
  section.torsion_stiffness = g * shape.torsion;
  section.shear_stiffness_2 = shear_flexible ? shape.shear_factor_2 * g * shape.area : 0;
  section.shear_stiffness_3 = shear_flexible ? shape.shear_factor_3 * g * shape.area : 0;
  section.mass_per_length = rho * shape.area;
  section.rotary_inertia_2 = rho * shape.inertia_2;
  section.rotary_inertia_3 = rho * shape.inertia_3;
  return section;
}

Shape rectangle(double width, double height) {
  const double a = std::max(width, height) / 2, b = std::min(width, height) / 2, r = b / a;
  const double torsion = a * b * b * b * (16.0 / 3.0 - 3.36 * r * (1 - r * r * r * r / 12));
  return {
      width * height, width * std::pow(height, 3) / 12, height * std::pow(width, 3) / 12, torsion, 5.0 / 6.0,
      5.0 / 6.0};
}

Shape round_bar(double diameter, double nu) {
  const double inertia = pi * std::pow(diameter, 4) / 64, factor = 6 * (1 + nu) / (7 + 6 * nu);
  return {pi * diameter * diameter / 4, inertia, inertia, 2 * inertia, factor, factor};
}

Shape tube(double mean_diameter, double thickness, double nu) {
  const double outer = mean_diameter + thickness, inner = mean_diameter - thickness;
  const double inertia = pi * (std::pow(outer, 4) - std::pow(inner, 4)) / 64, m = inner / outer;
  const double factor = 6 * (1 + nu) * std::pow(1 + m * m, 2) /
                        ((7 + 6 * nu) * std::pow(1 + m * m, 2) + (20 + 12 * nu) * m * m);
  return {pi * (outer * outer - inner * inner) / 4, inertia, inertia, 2 * inertia, factor, factor};
}

CableSection cable_section(const CableSectionOptions& o, const Materials& materials) {
  CableSection section;
  if (!o.material.empty()) {
    const auto& material = materials.at(o.material);
    const double area = o.area ? *o.area : pi * std::pow(o.diameter.value_or(0), 2) / 4;
    section = {material.young_modulus * area, material.density * area};
  }
  if (o.axial_stiffness) section.axial_stiffness = *o.axial_stiffness;
  if (o.mass_per_length) section.mass_per_length = *o.mass_per_length;
  return section;
}

element::MembraneSection membrane_section(const MembraneSectionOptions& o, const Materials& materials) {
  element::MembraneSection section;
  if (!o.material.empty()) {
    const auto& material = materials.at(o.material);
    const double thickness = o.thickness.value_or(0);
    section = {material.young_modulus * thickness, material.poisson_ratio, material.density * thickness};
  }
  if (o.tension_stiffness) section.tension_stiffness = *o.tension_stiffness;
  if (o.poisson_ratio) section.poisson_ratio = *o.poisson_ratio;
  if (o.mass_per_area) section.mass_per_area = *o.mass_per_area;
  return section;
}

element::BeamSection general(const GeneralBeamSectionOptions& o) {
  return {o.axial_stiffness,   o.bending_stiffness_2, o.bending_stiffness_3,
          o.torsion_stiffness, o.shear_stiffness_2,   o.shear_stiffness_3,
          o.mass_per_length,   o.rotary_inertia_2,    o.rotary_inertia_3};
}

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};

}  // namespace

ElementKind kind_of(const SectionOptions& section) {
  if (std::holds_alternative<CableSectionOptions>(section)) return ElementKind::cable;
  if (std::holds_alternative<MembraneSectionOptions>(section)) return ElementKind::membrane;
  return ElementKind::beam;
}

void set_section(Group& group, const SectionOptions& section, const Materials& materials) {
  group.kind = kind_of(section);
  std::visit(
      Overloaded{[&](const CableSectionOptions& o) { group.cable = cable_section(o, materials); },
                 [&](const MembraneSectionOptions& o) { group.membrane = membrane_section(o, materials); },
                 [&](const RectangleSectionOptions& o) {
                   group.beam =
                       beam_section(rectangle(o.width, o.height), materials.at(o.material), o.shear_flexible);
                 },
                 [&](const RoundSectionOptions& o) {
                   const auto& material = materials.at(o.material);
                   group.beam = beam_section(round_bar(o.diameter, material.poisson_ratio), material,
                                             o.shear_flexible);
                 },
                 [&](const TubeSectionOptions& o) {
                   const auto& material = materials.at(o.material);
                   group.beam = beam_section(tube(o.diameter, o.thickness, material.poisson_ratio), material,
                                             o.shear_flexible);
                 },
                 [&](const GeneralBeamSectionOptions& o) { group.beam = general(o); }},
      section);
}

void set_initial_state(Model& model, int group, const GroupOptions& options) {
  const double stiffness = model.groups[group].cable.axial_stiffness;
  for (auto& cable : model.cables) {
    if (cable.group != group) continue;
    const double length = model.reference_length(cable);
    if (options.tension) cable.initial_strain = *options.tension / stiffness;
    if (options.force_density) cable.initial_strain = *options.force_density * length / stiffness;
    if (options.unstressed_length) cable.initial_strain = length / *options.unstressed_length - 1;
    if (options.prestrain) cable.initial_strain = *options.prestrain;
  }
  for (auto& membrane : model.membranes)
    if (membrane.group == group && options.prestress)
      membrane.prestress = {*options.prestress, *options.prestress, 0};
}

}  // namespace tautline::model
