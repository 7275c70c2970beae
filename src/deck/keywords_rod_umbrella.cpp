#include <fmt/format.h>

#include <deck/builder.hpp>
#include <stdexcept>
#include <tautline/core/expression.hpp>
#include <deck/keywords.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using rod::CableOptions, rod::MeridianOptions, rod::UmbrellaOptions;

void read_points(Reader& reader, const Keyword& keyword, const Node& node, MeridianOptions& options) {
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  options.kind = rod::MeridianKind::table;
  if (node.items.size() < 2)
    reader.complain(node, node.items.empty() ? "no points make no curve" : "one point makes no curve",
                    "expected two points at least");
  for (const auto& point : node.items) {
    if (!point.is_sequence()) {
      reader.wrong_value(keyword, point, "does not fit here");
      continue;
    }
    const auto xy = reader.pair(keyword, point);
    if (!xy) continue;
    if (!options.x.empty() && (*xy)[0] <= options.x.back())
      reader.complain(
          point, fmt::format("x = {} does not rise", format_number((*xy)[0])),
          fmt::format("expected x > {} [m], that of the point before", format_number(options.x.back())));
    options.x.push_back((*xy)[0]);
    options.y.push_back((*xy)[1]);
  }
}

void read_expression(Reader& reader, const Keyword& keyword, const Node& node, MeridianOptions& options) {
  options.kind = rod::MeridianKind::expression;
  const auto text = reader.text(keyword, node);
  if (!text) return;
  options.expression = *text;
  try {
    const Expression checked(*text);
  } catch (const std::invalid_argument& error) {
    reader.complain(node, fmt::format("\"{}\" is no formula: {}", *text, error.what()),
                    "expected a formula of X with + - * / ^, parentheses, pi and functions as sqrt or cosh");
  }
}

BlockSet make_meridian_blocks(const std::string& path) {
  BlockBuilder<MeridianOptions> b(path, "",
                                  "The curve Y = F(X) that makes the surface wanted by rotation about Y.");
  b.key("coefficient", &MeridianOptions::coefficient)
      .in("1/m")
      .above(0)
      .by_default("none; or give `points` or `expression`")
      .also_called({"lambda"})
      .says("Parabola Y = coefficient X^2; its focal length is 1/(4 coefficient).");
  b.custom("points", Type::points, read_points)
      .in("m")
      .by_default("none; or give `coefficient` or `expression`")
      .says("Any curve through points [x, y], x rising, from the root beyond the end of the rod.");
  b.custom("expression", Type::text, read_expression)
      .in("m")
      .by_default("none; or give `coefficient` or `points`")
      .says("A formula of X, e.g. \"0.1*X^2 - 0.0004*X^4\" or \"4*(cosh(X/4) - 1)\".");
  b.check([](Reader& reader, const Node& node, MeridianOptions&) {
    const Node* last = nullptr;
    int given = 0;
    for (const char* key : {"coefficient", "points", "expression"})
      if (const Node* found = node.find(key)) {
        last = found;
        ++given;
      }
    if (given != 1)
      reader.complain(given == 0 ? node.label : last->label,
                      given == 0 ? "the meridian is not given" : "the meridian is given twice",
                      reader.context(), "expected exactly one of: coefficient, points, expression");
  });
  return BlockSet{path, "The curve Y = F(X).", {b.take()}, {}};
}

const BlockSet& cable_blocks() {
  static const BlockSet set = [] {
    using rod::CableLaw;
    BlockBuilder<CableOptions> b("reflector.rod-umbrella.cable", "",
                                 "What a cable of a parallel does when stretched; slack it carries nothing.");
    b.choice("law", &CableOptions::law,
             std::vector<std::pair<std::string, CableLaw>>{{"linear", CableLaw::linear},
                                                           {"bilinear", CableLaw::bilinear}})
        .says("linear: tension = stiffness x strain; bilinear: another slope beyond `knee_strain`.");
    b.key("knee_strain", &CableOptions::knee_strain)
        .above(0)
        .by_default("required with law bilinear")
        .says("Law bilinear: strain at which the slope changes.");
    b.key("second_slope", &CableOptions::second_slope)
        .above(0)
        .says("Law bilinear: slope beyond the knee as a part of the stiffness.");
    b.key("strain_limit", &CableOptions::strain_limit)
        .above(0)
        .says("A cable strained beyond it is warned of.");
    b.check([](Reader& reader, const Node& node, CableOptions& options) {
      const Node* knee = node.find("knee_strain");
      if (options.law == CableLaw::bilinear && knee == nullptr)
        reader.complain(node.find("law")->label, "law bilinear has no \"knee_strain\"", reader.context(),
                        "expected knee_strain: a number > 0");
      for (const char* key : {"knee_strain", "second_slope"})
        if (const Node* value = node.find(key); value != nullptr && options.law == CableLaw::linear)
          reader.complain(value->label, fmt::format("\"{}\" has no effect with law linear", key),
                          reader.context(), {}, "it belongs to law: bilinear");
    });
    return BlockSet{"reflector.rod-umbrella.cable", "The cables of the parallels.", {b.take()}, {}};
  }();
  return set;
}

void check_umbrella(Reader& reader, const Node& node, UmbrellaOptions& options) {
  for (const auto& [key, values] :
       {std::pair{"lengths", &options.lengths}, std::pair{"bending_stiffness", &options.bending_stiffness},
        std::pair{"axial_stiffness", &options.axial_stiffness},
        std::pair{"torsion_stiffness", &options.torsion_stiffness},
        std::pair{"mass_per_length", &options.mass_per_length}}) {
    const Node* list = node.find(key);
    const auto n = static_cast<int>(values->size());
    if (list == nullptr || n <= 1 || n == options.links) continue;
    reader.complain(*list, fmt::format("{} has {} numbers for {} links", key, n, options.links),
                    fmt::format("expected one number for all, or {}, from the root outwards", options.links));
  }
  if (const Node* offset = node.find("root_offset");
      offset != nullptr && options.root_offset >= options.root_radius)
    reader.complain(
        *offset,
        fmt::format("root_offset = {} puts the hinge beyond the axis", format_number(options.root_offset)),
        fmt::format("expected less than root_radius = {} [m]", format_number(options.root_radius)));
}

}  // namespace

const BlockSet& meridian_blocks() {
  static const BlockSet set = make_meridian_blocks("reflector.rod-umbrella.meridian");
  return set;
}

const BlockSet& target_meridian_blocks() {
  static const BlockSet set = make_meridian_blocks("steps.inverse.targets.meridian");
  return set;
}

Block rod_umbrella_block() {
  using Options = UmbrellaOptions;
  BlockBuilder<Reflector, Options> b(
      "reflector.rod-umbrella", "rod-umbrella",
      "Flexible rods, straight when deployed, that cables along the parallels "
      "bend to a surface of revolution. "
      "It needs no sections, groups or supports. The step `rod_shaping` finds the "
      "cables and leaves beams `link_1`, ... and cables `parallel_1`, ... in "
      "space to the steps after it; the load `turn` takes the `roots` to the stop.");
  b.key("rods", &Options::rods)
      .at_least(3)
      .at_most(10000)
      .required()
      .also_called({"n"})
      .says("Number of rods, evenly spread.");
  b.key("links", &Options::links)
      .at_least(1)
      .at_most(10000)
      .required()
      .also_called({"m"})
      .says("Links of each rod; the end of each is a node with a cable.");
  b.key("lengths", &Options::lengths)
      .in("m")
      .above(0)
      .required()
      .also_called({"length"})
      .says("Length of the links, from the root outwards.");
  b.key("bending_stiffness", &Options::bending_stiffness)
      .in("N m2")
      .above(0)
      .required()
      .also_called({"EI"})
      .says("Bending stiffness EI of the links, from the root outwards.");
  b.key("root_radius", &Options::root_radius)
      .in("m")
      .at_least(0)
      .says("Distance a_0 of the root of the flexible part from the axis when it stands at the stop.");
  b.key("root_offset", &Options::root_offset)
      .in("m")
      .says(
          "By how much the root is nearer to the axis, along the rod, while the rod is straight (delta_0).");
  b.key("straight_angle", &Options::straight_angle)
      .in("degree")
      .above(-90)
      .below(90)
      .also_called({"beta_0"})
      .says("Angle beta_0 of the straight rods to the plane across the axis; the cables are then just taut.");
  b.key("axial_stiffness", &Options::axial_stiffness)
      .in("N")
      .above(0)
      .by_default("1e10, as good as inextensible")
      .also_called({"EA"})
      .says("Stiffness EA of the links as beams in space; `rod_shaping` takes them as inextensible.");
  b.key("torsion_stiffness", &Options::torsion_stiffness)
      .in("N m2")
      .above(0)
      .by_default("EI/1.3, a round section")
      .also_called({"GJ"})
      .says("Stiffness GJ of the links as beams in space.");
  b.key("mass_per_length", &Options::mass_per_length)
      .in("kg/m")
      .at_least(0)
      .by_default("0")
      .says("Mass of the links as beams in space, for weight and modes; the cables have none.");
  b.block("meridian", &Options::meridian, meridian_blocks()).required().says("The curve to be met.");
  b.block("cable", &Options::cable, cable_blocks()).says("The law of the cables.");
  b.check(check_umbrella);
  return b.take();
}

}  // namespace tautline::deck
