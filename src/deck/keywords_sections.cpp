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

Block make_cable() {
  using Options = CableSectionOptions;
  BlockBuilder<SectionOptions, Options> b("sections.cable", "cable",
                                          "A cord: tension only. Either axial_stiffness and mass_per_length, "
                                          "or a material with diameter or area.");
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
      .says("Mass per length; 0 for a massless cord.");
  b.check([](Reader& reader, const Node& node, Options&) {
    check_either(reader, node, {"axial_stiffness", "mass_per_length"}, {"diameter", "area"},
                 "(diameter or area)");
  });
  return b.take();
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
  b.check([](Reader& reader, const Node& node, Options& options) {
    const Node* wall = node.find("thickness");
    if (wall == nullptr || options.diameter <= 0 || options.thickness < options.diameter) return;
    reader.complain(
        *wall, fmt::format("thickness = {} leaves no tube", format_number(options.thickness)),
        fmt::format("expected less than the mean diameter = {} [m]", format_number(options.diameter)));
  });
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
  b.check([](Reader& reader, const Node& node, Options&) {
    check_either(reader, node, {"tension_stiffness", "poisson_ratio", "mass_per_area"}, {"thickness"},
                 "thickness");
  });
  return b.take();
}

}  // namespace

const BlockSet& section_blocks() {
  static const BlockSet set{
      "sections",
      "Sections by name; `kind` says of what.",
      {make_cable(), make_rectangle(), make_round(), make_tube(), make_beam(), make_membrane()},
      {}};
  return set;
}

}  // namespace tautline::deck
