#include <tautline/model/section.hpp>

#include <cmath>
#include <numbers>

#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>

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

/// Torsion by Bredt's formula, shear factor by Cowper (1966), both for thin walls.
Shape square_tube(double side, double thickness, double nu) {
  const double inertia = 2 * side * thickness * (side * side + thickness * thickness) / 3;
  const double factor = 20 * (1 + nu) / (48 + 39 * nu);
  return {4 * side * thickness, inertia, inertia, std::pow(side, 3) * thickness, factor, factor};
}

Shape i_section(const ISectionOptions& o) {
  const double web = o.height - 2 * o.flange_thickness, flanges = 2 * o.width * o.flange_thickness;
  const double area = flanges + web * o.web_thickness;
  const double inertia_2 =
      (o.width * std::pow(o.height, 3) - (o.width - o.web_thickness) * std::pow(web, 3)) / 12;
  const double inertia_3 =
      (2 * o.flange_thickness * std::pow(o.width, 3) + web * std::pow(o.web_thickness, 3)) / 12;
  const double torsion =
      (2 * o.width * std::pow(o.flange_thickness, 3) + web * std::pow(o.web_thickness, 3)) / 3;
  return {area, inertia_2, inertia_3, torsion, 5.0 / 6.0 * flanges / area, o.height * o.web_thickness / area};
}

void set_axial(Group& group, const AxialSectionOptions& o, const Materials& materials) {
  if (!o.material.empty()) {
    const auto& material = materials.at(o.material);
    const double area = o.area ? *o.area : pi * std::pow(o.diameter.value_or(0), 2) / 4;
    group.cable = {material.young_modulus * area, material.density * area};
    group.thermal_expansion = material.thermal_expansion;
  }
  if (o.axial_stiffness) group.cable.axial_stiffness = *o.axial_stiffness;
  if (o.mass_per_length) group.cable.mass_per_length = *o.mass_per_length;
  if (o.thermal_expansion) group.thermal_expansion = *o.thermal_expansion;
}

element::MembraneSection membrane_section(const MembraneSectionOptions& o, const Materials& materials) {
  element::MembraneSection section;
  if (!o.material.empty()) {
    const auto& material = materials.at(o.material);
    const double thickness = o.thickness.value_or(0);
    section.tension_stiffness = material.young_modulus * thickness;
    section.poisson_ratio = material.poisson_ratio;
    section.mass_per_area = material.density * thickness;
    section.thermal_expansion = material.thermal_expansion;
  }
  const auto take = [](const std::optional<double>& from, double& to) {
    if (from) to = *from;
  };
  take(o.tension_stiffness, section.tension_stiffness);
  take(o.poisson_ratio, section.poisson_ratio);
  take(o.mass_per_area, section.mass_per_area);
  take(o.tension_stiffness_2, section.tension_stiffness_2);
  take(o.shear_stiffness, section.shear_stiffness);
  take(o.thermal_expansion, section.thermal_expansion);
  section.thermal_expansion_2 = o.thermal_expansion_2.value_or(section.thermal_expansion);
  section.wrinkling = o.wrinkling;
  return section;
}

element::ShellSection shell_section(const ShellSectionOptions& o, const Materials& materials) {
  const auto& m = materials.at(o.material);
  return {m.young_modulus, m.poisson_ratio, o.thickness, m.density, o.shear_factor, m.thermal_expansion};
}

TaperedTube tapered_tube(const TaperedTubeSectionOptions& o, const Materials& materials) {
  return {{o.diameter_start, o.diameter_end},
          {o.thickness_start, o.thickness_end},
          materials.at(o.material),
          o.shear_flexible};
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

element::BeamSection tapered_section(const TaperedTube& t, double place) {
  const auto at = [&](const std::array<double, 2>& ends) { return (1 - place) * ends[0] + place * ends[1]; };
  return beam_section(tube(at(t.diameter), at(t.thickness), t.material.poisson_ratio), t.material,
                      t.shear_flexible);
}

ElementKind kind_of(const SectionOptions& section) {
  return std::visit(Overloaded{[](const CableSectionOptions&) { return ElementKind::cable; },
                               [](const BarSectionOptions&) { return ElementKind::bar; },
                               [](const CatenarySectionOptions&) { return ElementKind::catenary; },
                               [](const MembraneSectionOptions&) { return ElementKind::membrane; },
                               [](const ShellSectionOptions&) { return ElementKind::shell; },
                               [](const SpringSectionOptions&) { return ElementKind::spring; },
                               [](const MassSectionOptions&) { return ElementKind::mass; },
                               [](const RigidLinkSectionOptions&) { return ElementKind::link; },
                               [](const HingeSectionOptions&) { return ElementKind::link; },
                               [](const auto&) { return ElementKind::beam; }},
                    section);
}

namespace {

/// Fills the part of a group that its kind of section means.
class SectionSetter {
 public:
  SectionSetter(Group& group, const Materials& materials) : group_(group), materials_(materials) {}

  void operator()(const AxialSectionOptions& o) const { set_axial(group_, o, materials_); }
  void operator()(const MembraneSectionOptions& o) const {
    group_.membrane = membrane_section(o, materials_);
  }
  void operator()(const ShellSectionOptions& o) const { group_.shell = shell_section(o, materials_); }
  void operator()(const SpringSectionOptions& o) const {
    group_.spring = {o.stiffness, o.rotational_stiffness};
  }
  void operator()(const MassSectionOptions& o) const { group_.mass = {o.mass, o.inertia}; }
  void operator()(const RigidLinkSectionOptions&) const {}
  void operator()(const HingeSectionOptions&) const {}
  void operator()(const RectangleSectionOptions& o) const { set(o, rectangle(o.width, o.height)); }
  void operator()(const RoundSectionOptions& o) const { set(o, round_bar(o.diameter, poisson(o))); }
  void operator()(const TubeSectionOptions& o) const {
    set(o, tube(o.diameter, o.thickness, poisson(o)));
    group_.tube = {
        {o.diameter, o.diameter}, {o.thickness, o.thickness}, materials_.at(o.material), o.shear_flexible};
  }
  void operator()(const SquareTubeSectionOptions& o) const {
    set(o, square_tube(o.side, o.thickness, poisson(o)));
  }
  void operator()(const ISectionOptions& o) const { set(o, i_section(o)); }
  void operator()(const GeneralSectionOptions& o) const {
    const auto& m = materials_.at(o.material);
    group_.beam = beam_section(
        {o.area, o.inertia_2, o.inertia_3, o.torsion, o.shear_factor_2, o.shear_factor_3}, m, true);
    group_.thermal_expansion = m.thermal_expansion;
  }
  void operator()(const GeneralBeamSectionOptions& o) const {
    group_.beam = general(o);
    group_.thermal_expansion = o.thermal_expansion;
  }
  void operator()(const TaperedTubeSectionOptions& o) const {
    group_.taper = group_.tube = tapered_tube(o, materials_);
    group_.beam = tapered_section(*group_.taper, 0.5);
    group_.thermal_expansion = group_.taper->material.thermal_expansion;
  }

 private:
  template <class Options>
  double poisson(const Options& o) const {
    return materials_.at(o.material).poisson_ratio;
  }
  template <class Options>
  void set(const Options& o, const Shape& shape) const {
    const auto& material = materials_.at(o.material);
    group_.beam = beam_section(shape, material, o.shear_flexible);
    group_.thermal_expansion = material.thermal_expansion;
  }

  Group& group_;
  const Materials& materials_;
};

template <int N>
Mat3 frame_of(const Model& model, const Membrane& membrane) {
  return element::membrane_frame<N>(reference_nodes<N>(model, membrane.nodes));
}
template <int N>
Mat3 frame_of(const Model& model, const Shell& shell) {
  return element::shell_frame<N>(reference_nodes<N>(model, shell.nodes));
}

template <class Facets>
void prestress_facets(Model& model, Facets& facets, int group, const std::array<double, 2>& resultants) {
  for (auto& facet : facets)
    if (facet.group == group)
      facet.prestress =
          along_orientation(facet.nodes.size() == 3 ? frame_of<3>(model, facet) : frame_of<4>(model, facet),
                            axis_1(model.groups[group]), resultants);
}

}  // namespace

Vec3 along_orientation(const Mat3& frame, const Vec3& orientation, const std::array<double, 2>& n) {
  if (n[0] == n[1]) return {n[0], n[1], 0};
  const double angle = angle_in(frame, orientation), c = std::cos(angle), s = std::sin(angle);
  return {c * c * n[0] + s * s * n[1], s * s * n[0] + c * c * n[1], c * s * (n[0] - n[1])};
}

void set_section(Group& group, const SectionOptions& section, const Materials& materials) {
  group.kind = kind_of(section);
  std::visit(SectionSetter(group, materials), section);
}

void set_initial_state(Model& model, int group, const GroupOptions& options, double thickness) {
  const double stiffness = model.groups[group].cable.axial_stiffness;
  for (auto& cable : model.cables) {
    if (cable.group != group) continue;
    const double length = model.reference_length(cable);
    if (options.tension) cable.initial_strain = *options.tension / stiffness;
    if (options.force_density) cable.initial_strain = *options.force_density * length / stiffness;
    if (options.unstressed_length) cable.initial_strain = length / *options.unstressed_length - 1;
    if (options.prestrain) cable.initial_strain = *options.prestrain;
  }
  auto resultants = options.prestress;
  if (options.initial_stress) {
    resultants = options.initial_stress;
    for (double& value : *resultants) value *= thickness;
  }
  if (!resultants) return;
  prestress_facets(model, model.membranes, group, *resultants);
  prestress_facets(model, model.shells, group, *resultants);
}

}  // namespace tautline::model
