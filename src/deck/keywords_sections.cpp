#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

using namespace model;

/// Stiffness given directly or by material: complains unless exactly one way is complete.
void check_either(Reader& reader, const Node& node, const std::vector<std::string>& direct,
                  const std::vector<std::string>& material_side, const std::string& material_need) {
  std::vector<std::string> given, missing;
  for (const auto& key : direct) (node.find(key) != nullptr ? given : missing).push_back(key);
  const Node* material = node.find("material");
  const std::string ways =
      fmt::format("expected either {} or material + {}", join(direct, " + "), material_need);
  if (material != nullptr && !given.empty())
    return reader.complain(*node.find(given.front()),
                           fmt::format("both \"material\" and \"{}\" are given", given.front()), ways);
  if (material == nullptr && given.empty())
    return reader.complain(node.label, fmt::format("missing key \"material\" or \"{}\"", direct.front()),
                           reader.context(), ways);
  std::vector<std::string> sizes;
  for (const auto& key : material_side)
    if (node.find(key) != nullptr) sizes.push_back(key);
  if (material == nullptr && !missing.empty())
    return reader.complain(node.label, fmt::format("missing key \"{}\"", join(missing, "\", \"")),
                           reader.context(), ways);
  if (material == nullptr && !sizes.empty())
    return reader.complain(*node.find(sizes.front()),
                           fmt::format("\"{}\" has no effect without \"material\"", sizes.front()), ways);
  if (material != nullptr && sizes.empty())
    return reader.complain(node.label, fmt::format("missing key \"{}\"", join(material_side, "\" or \"")),
                           reader.context(), ways);
  if (material != nullptr && sizes.size() > 1)
    reader.complain(*node.find(sizes[1]), fmt::format("both \"{}\" and \"{}\" are given", sizes[0], sizes[1]),
                    "expected exactly one of them");
}

/// Cable, bar and catenary are told alike.
template <class Options>
Block make_axial(const std::string& kind, const std::string& sentence) {
  BlockBuilder<SectionOptions, Options> b("sections." + kind, kind, sentence);
  b.key("material", &Options::material).refers("material").says("Material; needs `diameter` or `area`.");
  b.key("diameter", &Options::diameter).in("m").above(0).says("Diameter of the full circular section.");
  b.key("area", &Options::area).in("m^2").above(0).also_called({"A"}).says("Area of the section.");
  b.key("axial_stiffness", &Options::axial_stiffness)
      .in("N")
      .above(0)
      .also_called({"EA", "stiffness"})
      .says("Axial stiffness E A.");
  b.key("mass_per_length", &Options::mass_per_length)
      .in("kg/m")
      .at_least(0)
      .says("Mass per unstressed length; 0 for a massless cord.");
  b.key("thermal_expansion", &Options::thermal_expansion)
      .in("1/K")
      .by_default("the material's, or 0")
      .says("Coefficient of thermal expansion.");
  b.check([](Reader& reader, const Node& node, Options&) {
    check_either(reader, node, {"axial_stiffness", "mass_per_length"}, {"diameter", "area"},
                 "(diameter or area)");
  });
  return b.take();
}

Block make_cable() {
  return make_axial<CableSectionOptions>("cable",
                                         "A cord: tension only. Either axial_stiffness and mass_per_length, "
                                         "or a material with diameter or area.");
}

Block make_bar() {
  return make_axial<BarSectionOptions>(
      "bar",
      "A straight bar, hinged at its ends: tension and compression. Given like a "
      "cable.");
}

Block make_catenary() {
  return make_axial<CatenarySectionOptions>("catenary",
                                            "A whole hanging cable as one element, sagging under its own "
                                            "weight. Given like a cable.");
}

Block make_rectangle() {
  using Options = RectangleSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.rectangle", "rectangle",
                                          "A beam of full rectangular section.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("width", &Options::width).in("m").above(0).required().says("Width, along local axis 2.");
  b.key("height", &Options::height).in("m").above(0).required().says("Height, along local axis 3.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  return b.take();
}

Block make_round() {
  using Options = RoundSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.round", "round", "A beam of full circular section.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("diameter", &Options::diameter).in("m").above(0).required().says("Diameter.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  return b.take();
}

/// The wall of a tube leaves something inside.
void check_wall(Reader& reader, const Node& node, const char* key, double thickness, double diameter) {
  const Node* wall = node.find(key);
  if (wall == nullptr || diameter <= 0 || thickness < diameter) return;
  reader.complain(*wall, fmt::format("{} = {} leaves no tube", key, format_number(thickness)),
                  fmt::format("expected less than the mean diameter = {} [m]", format_number(diameter)));
}

Block make_tube() {
  using Options = TubeSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.tube", "tube", "A beam of circular tube.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("diameter", &Options::diameter).in("m").above(0).required().says("Mean diameter of the wall.");
  b.key("thickness", &Options::thickness)
      .in("m")
      .above(0)
      .required()
      .says("Thickness of the wall; less than the diameter.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    check_wall(reader, node, "thickness", o.thickness, o.diameter);
  });
  return b.take();
}

Block make_square_tube() {
  using Options = SquareTubeSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.square_tube", "square_tube",
      "A beam of thin-walled square tube, its walls along local axes 2 and 3; torsion by Bredt's formula.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("side", &Options::side)
      .in("m")
      .above(0)
      .required()
      .says("Distance between the middles of opposite walls.");
  b.key("thickness", &Options::thickness)
      .in("m")
      .above(0)
      .required()
      .says("Thickness of the wall; less than the side.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    check_wall(reader, node, "thickness", o.thickness, o.side);
  });
  return b.take();
}

Block make_tapered_tube() {
  using Options = TaperedTubeSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.tapered_tube", "tapered_tube",
      "A beam of circular tube whose dimensions change linearly from its first "
      "to its second node; divide it with a `mesh` step.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("diameter_start", &Options::diameter_start)
      .in("m")
      .above(0)
      .required()
      .says("Mean diameter at the first node.");
  b.key("diameter_end", &Options::diameter_end)
      .in("m")
      .above(0)
      .required()
      .says("Mean diameter at the second node.");
  b.key("thickness_start", &Options::thickness_start)
      .in("m")
      .above(0)
      .required()
      .says("Wall at the first node.");
  b.key("thickness_end", &Options::thickness_end)
      .in("m")
      .above(0)
      .required()
      .says("Wall at the second node.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    check_wall(reader, node, "thickness_start", o.thickness_start, o.diameter_start);
    check_wall(reader, node, "thickness_end", o.thickness_end, o.diameter_end);
  });
  return b.take();
}

Block make_i() {
  using Options = ISectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.i", "i",
                                          "A beam of I section with equal flanges: web along local axis 3.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("height", &Options::height)
      .in("m")
      .above(0)
      .required()
      .says("Height over both flanges, along local axis 3.");
  b.key("width", &Options::width)
      .in("m")
      .above(0)
      .required()
      .says("Width of the flanges, along local axis 2.");
  b.key("web_thickness", &Options::web_thickness).in("m").above(0).required().says("Thickness of the web.");
  b.key("flange_thickness", &Options::flange_thickness)
      .in("m")
      .above(0)
      .required()
      .says("Thickness of a flange.");
  b.key("shear_flexible", &Options::shear_flexible)
      .says("Whether the beam shears (Timoshenko) or is rigid in shear.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    if (const Node* flange = node.find("flange_thickness");
        flange != nullptr && 2 * o.flange_thickness >= o.height)
      reader.complain(*flange, "the flanges leave no web", "expected less than half of the height");
    if (const Node* web = node.find("web_thickness"); web != nullptr && o.web_thickness > o.width)
      reader.complain(*web, "the web is wider than the flanges", "expected at most the width");
  });
  return b.take();
}

Block make_general() {
  using Options = GeneralSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.general", "general",
                                          "A beam given by area and second moments, with a material.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("area", &Options::area).in("m^2").above(0).required().also_called({"A"}).says("Area of the section.");
  b.key("inertia_2", &Options::inertia_2)
      .in("m^4")
      .above(0)
      .required()
      .also_called({"I2", "Iy"})
      .says("Second moment of area about local axis 2.");
  b.key("inertia_3", &Options::inertia_3)
      .in("m^4")
      .above(0)
      .required()
      .also_called({"I3", "Iz"})
      .says("Second moment of area about local axis 3.");
  b.key("torsion", &Options::torsion)
      .in("m^4")
      .above(0)
      .required()
      .also_called({"J"})
      .says("Torsion constant.");
  b.key("shear_factor_2", &Options::shear_factor_2)
      .at_least(0)
      .says("Part of the area that shears along local axis 2; 0: rigid in shear.");
  b.key("shear_factor_3", &Options::shear_factor_3)
      .at_least(0)
      .says("Part of the area that shears along local axis 3; 0: rigid in shear.");
  return b.take();
}

Block make_beam() {
  using Options = GeneralBeamSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.beam", "beam", "A beam whose stiffnesses are given.");
  b.key("axial_stiffness", &Options::axial_stiffness)
      .in("N")
      .above(0)
      .required()
      .also_called({"EA"})
      .says("Axial stiffness E A.");
  b.key("bending_stiffness_2", &Options::bending_stiffness_2)
      .in("N m^2")
      .above(0)
      .required()
      .says("Bending stiffness E I about local axis 2.");
  b.key("bending_stiffness_3", &Options::bending_stiffness_3)
      .in("N m^2")
      .above(0)
      .required()
      .says("Bending stiffness E I about local axis 3.");
  b.key("torsion_stiffness", &Options::torsion_stiffness)
      .in("N m^2")
      .above(0)
      .required()
      .also_called({"GJ"})
      .says("Torsion stiffness G J.");
  b.key("shear_stiffness_2", &Options::shear_stiffness_2)
      .in("N")
      .at_least(0)
      .says("Shear stiffness along local axis 2; 0: rigid in shear.");
  b.key("shear_stiffness_3", &Options::shear_stiffness_3)
      .in("N")
      .at_least(0)
      .says("Shear stiffness along local axis 3; 0: rigid in shear.");
  b.key("mass_per_length", &Options::mass_per_length)
      .in("kg/m")
      .at_least(0)
      .required()
      .says("Mass per length.");
  b.key("rotary_inertia_2", &Options::rotary_inertia_2)
      .in("kg m")
      .at_least(0)
      .says("Rotary inertia per length about local axis 2.");
  b.key("rotary_inertia_3", &Options::rotary_inertia_3)
      .in("kg m")
      .at_least(0)
      .says("Rotary inertia per length about local axis 3.");
  b.key("thermal_expansion", &Options::thermal_expansion).in("1/K").says("Coefficient of thermal expansion.");
  return b.take();
}

Block make_membrane() {
  using Options = MembraneSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.membrane", "membrane",
                                          "Cloth or film. Either tension_stiffness, poisson_ratio and "
                                          "mass_per_area, or a material with thickness.");
  b.key("material", &Options::material).refers("material").says("Material; needs `thickness`.");
  b.key("thickness", &Options::thickness).in("m").above(0).says("Thickness.");
  b.key("tension_stiffness", &Options::tension_stiffness)
      .in("N/m")
      .above(0)
      .also_called({"Eh"})
      .says("Tension stiffness E h.");
  b.key("poisson_ratio", &Options::poisson_ratio)
      .above(-1)
      .at_most(0.5)
      .also_called({"nu", "poisson"})
      .says("Poisson's ratio.");
  b.key("mass_per_area", &Options::mass_per_area)
      .in("kg/m^2")
      .at_least(0)
      .says("Mass per area; 0 for massless cloth.");
  b.key("tension_stiffness_2", &Options::tension_stiffness_2)
      .in("N/m")
      .above(0)
      .says("Orthotropic cloth: tension stiffness along axis 2; the other values are then along axis 1.");
  b.key("shear_stiffness", &Options::shear_stiffness)
      .in("N/m")
      .above(0)
      .also_called({"Gh"})
      .says("Orthotropic cloth: in-plane shear stiffness G h.");
  b.key("thermal_expansion", &Options::thermal_expansion)
      .in("1/K")
      .by_default("the material's, or 0")
      .says("Coefficient of thermal expansion, along axis 1 of orthotropic cloth.");
  b.key("thermal_expansion_2", &Options::thermal_expansion_2)
      .in("1/K")
      .by_default("as along axis 1")
      .says("Orthotropic cloth: coefficient of thermal expansion along axis 2.");
  b.key("wrinkling", &Options::wrinkling)
      .says("Whether the cloth wrinkles instead of carrying compression (tension field).");
  b.check([](Reader& reader, const Node& node, Options&) {
    check_either(reader, node, {"tension_stiffness", "poisson_ratio", "mass_per_area"}, {"thickness"},
                 "thickness");
    const Node *second = node.find("tension_stiffness_2"), *shear = node.find("shear_stiffness");
    if ((second == nullptr) != (shear == nullptr))
      reader.complain(node.label,
                      fmt::format("missing key \"{}\"", second ? "shear_stiffness" : "tension_stiffness_2"),
                      reader.context(), "expected tension_stiffness_2 and shear_stiffness together");
  });
  return b.take();
}

Block make_shell() {
  using Options = ShellSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.shell", "shell", "A shell of uniform thickness: membrane, bending and transverse shear.");
  b.key("material", &Options::material).required().refers("material").says("Material.");
  b.key("thickness", &Options::thickness).in("m").above(0).required().says("Thickness.");
  b.key("shear_factor", &Options::shear_factor).above(0).at_most(1).says("Shear correction factor.");
  return b.take();
}

Block make_spring() {
  using Options = SpringSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.spring", "spring",
      "A spring between two nodes at the same place, or from one node to the "
      "ground. With rotational stiffness its axes turn with its first node.");
  b.key("stiffness", &Options::stiffness)
      .in("N/m")
      .at_least(0)
      .by_default("[0, 0, 0]")
      .says("Stiffness along x, y, z.");
  b.key("rotational_stiffness", &Options::rotational_stiffness)
      .in("N m/rad")
      .at_least(0)
      .by_default("[0, 0, 0]")
      .says("Stiffness about x, y, z.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    if (o.stiffness.isZero(0) && o.rotational_stiffness.isZero(0))
      reader.complain(node.label, "a spring without stiffness", reader.context(),
                      "expected stiffness or rotational_stiffness above 0");
  });
  return b.take();
}

Block make_mass() {
  using Options = MassSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.mass", "mass", "A mass at a node.");
  b.key("mass", &Options::mass).in("kg").at_least(0).required().says("Mass of each.");
  b.key("inertia", &Options::inertia)
      .in("kg m^2")
      .at_least(0)
      .by_default("[0, 0, 0]")
      .says("Moments of inertia about x, y, z.");
  return b.take();
}

Block make_rigid_link() {
  using Options = RigidLinkSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.rigid_link", "rigid_link",
      "A rigid arm from the first node of each element, which leads, to the "
      "second, which follows.");
  b.key("rotation", &Options::rotation).says("Whether the second node turns with the arm, or freely.");
  return b.take();
}

Block make_hinge() {
  using Options = HingeSectionOptions;
  BlockBuilder<SectionOptions, Options> b(
      "sections.hinge", "hinge",
      "The second node of each element stays where the first is, or at the end "
      "of a rigid arm from there, and turns against it.");
  b.key("axis", &Options::axis)
      .by_default("none: a ball joint")
      .says("Axis about which it turns, fixed in the first node.");
  b.check([](Reader& reader, const Node& node, Options& o) {
    if (o.axis && o.axis->isZero(0))
      reader.complain(*node.find("axis"), "axis has no direction", "expected a vector that is not zero");
  });
  return b.take();
}

}  // namespace

const BlockSet& section_blocks() {
  static const BlockSet set{
      "sections",
      "Sections by name; `kind` says of what.",
      {make_cable(), make_bar(), make_catenary(), make_rectangle(), make_round(), make_tube(),
       make_square_tube(), make_tapered_tube(), make_i(), make_general(), make_beam(), make_membrane(),
       make_shell(), make_spring(), make_mass(), make_rigid_link(), make_hinge()},
      {}};
  return set;
}

}  // namespace tautline::deck
