#include <cmath>
#include <deck/builder.hpp>
#include <deck/dish_keys.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using Options = reflector::PerimeterTrussOptions;

void check_struts(Reader& reader, const Node& node, Options& options) {
  const Node* struts = node.find("struts");
  const int rim_nodes = 6 * options.rings;
  if (struts == nullptr || options.struts < 3 || options.rings < 1 || rim_nodes % options.struts == 0) return;
  std::vector<std::string> fitting;
  for (int n = 3; n <= rim_nodes; ++n)
    if (rim_nodes % n == 0) fitting.push_back(std::to_string(n));
  reader.complain(*struts,
                  fmt::format("{} struts cannot be spread evenly over {} rim nodes (6 x rings)",
                              options.struts, rim_nodes),
                  "expected one of: " + join(fitting));
}

Block make_perimeter_truss() {
  BlockBuilder<Reflector, Options> b(
      "reflector.perimeter-truss", "perimeter-truss",
      "Two triangular nets joined by ties between an upper and a lower rim that struts "
      "and crossed cords hold apart.");
  add_surface_keys(b);
  add_triangular_net_keys(b);
  b.key("struts", &Options::struts)
      .at_least(3)
      .by_default("3 x rings: one for each second rim node")
      .says("Number of struts, evenly spread; a divisor of 6 x rings.");
  b.key("held_strut", &Options::held_strut)
      .in("degree")
      .at_least(-360)
      .at_most(360)
      .says("Azimuth of the strut in the selection `held_strut`.");
  b.key("diagonals", &Options::diagonals).says("Crossed cords in every bay between struts.");
  add_radius_key(b);
  add_frequency_key(b);
  b.check([](Reader& reader, const Node& node, Options& options) {
    check_clearance(reader, node, options);
    check_radius(reader, node, options);
    check_struts(reader, node, options);
  });
  return b.take();
}

}  // namespace

void check_clearance(Reader& reader, const Node& node, const reflector::DishOptions& options) {
  const double radius = options.aperture / 2;
  if (const Node* clearance = node.find("clearance");
      clearance != nullptr && radius > 0 && options.clearance < -radius)
    reader.complain(
        *clearance, fmt::format("clearance = {} lies outside the dish", format_number(options.clearance)),
        fmt::format("expected at least -aperture/2 = {} [m], where the parent axis is the centre of the dish",
                    format_number(-radius)));
}

void check_radius(Reader& reader, const Node& node, const reflector::DishOptions& options) {
  const double radius = options.aperture / 2;
  if (const Node* measured = node.find("evaluation_radius");
      measured != nullptr && radius > 0 && options.evaluation_radius > radius)
    reader.complain(*measured,
                    fmt::format("evaluation_radius = {} is larger than the dish",
                                format_number(options.evaluation_radius)),
                    fmt::format("expected at most aperture/2 = {} [m]", format_number(radius)));
}

const BlockSet& reflector_blocks() {
  static const BlockSet set{"reflector",
                            "A parametric reflector.",
                            {make_perimeter_truss(), tensegrity_rim_block(), umbrella_block(),
                             y_umbrella_block(), rod_umbrella_block()},
                            {}};
  return set;
}

bool is_complete_structure(const std::string& reflector_kind) {
  return reflector_kind == "rod-umbrella";
}

}  // namespace tautline::deck
