#include <cmath>
#include <deck/builder.hpp>
#include <deck/dish_keys.hpp>
#include <deck/keywords.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using Options = reflector::TensegrityRimOptions;

/// A cord reaches a rim node on its own side of the dish; the rim has as many nodes as struts.
void check_reach(Reader& reader, const Node& node, const Options& options) {
  const Node* reach = node.find("cord_reach");
  const int struts = 6 * options.rings;
  if (reach == nullptr || options.rings < 1 || !(options.cord_reach > 0)) return;
  const std::string given = fmt::format("cord_reach = {}", format_number(options.cord_reach));
  if (4 * options.cord_reach >= struts)
    reader.complain(*reach, given + " leads a quarter of the rim away",
                    fmt::format("expected less than a quarter of the {} struts (6 x rings)", struts));
  else if (2 * options.cord_reach != std::floor(2 * options.cord_reach))
    reader.complain(*reach, given + " is not a number of half distances",
                    "expected 0.5, 1, 1.5, ...: the rim's nodes lie opposite the struts or half-way between");
}

}  // namespace

Block tensegrity_rim_block() {
  BlockBuilder<Reflector, Options> b(
      "reflector.tensegrity-rim", "tensegrity-rim",
      "Two triangular nets joined by ties between the ends of struts of three links, which cords alone hold "
      "inside one rim.");
  add_surface_keys(b);
  add_triangular_net_keys(b);
  b.key("rim_offset", &Options::rim_offset)
      .in("m")
      .above(0)
      .required()
      .says("The rim's radius less that of the struts, on which the nets hang.");
  b.key("middle_link", &Options::middle_link)
      .above(0)
      .below(1)
      .says("Length of a strut's middle link over that of the strut.");
  b.key("cord_reach", &Options::cord_reach)
      .above(0)
      .says(
          "From each end of a strut cords go to the two rim nodes so many struts before and behind it; with "
          "0.5, 1.5, ... the rim's nodes lie half-way between the struts.");
  b.key("knee_cords", &Options::knee_cords)
      .says("Cords also from the two places where the links of a strut meet.");
  b.key("held_strut", &Options::held_strut)
      .in("degree")
      .at_least(-360)
      .at_most(360)
      .says("Azimuth of the strut in the selection `held_strut`.");
  add_radius_key(b);
  add_frequency_key(b);
  b.check([](Reader& reader, const Node& node, Options& options) {
    check_clearance(reader, node, options);
    check_radius(reader, node, options);
    check_reach(reader, node, options);
  });
  return b.take();
}

}  // namespace tautline::deck
