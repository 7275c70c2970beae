#include <fmt/format.h>

#include <algorithm>

#include <deck/builder.hpp>
#include <deck/dish_keys.hpp>
#include <deck/keywords.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using Options = reflector::UmbrellaOptions;

/// The joints of a spoke lie one behind the other.
void check_spoke(Reader& reader, const Node& node, const Options& options) {
  const auto behind = [&](const char* key, double radius, const char* before, double inner) {
    const Node* value = node.find(key);
    if (value == nullptr || node.find(before) == nullptr || radius > inner) return;
    reader.complain(*value,
                    fmt::format("{} = {} is not outside {} = {}", key, format_number(radius), before,
                                format_number(inner)),
                    fmt::format("expected more than {} [m]", format_number(inner)));
  };
  behind("joint_radius", options.joint_radius, "hub_radius", options.hub_radius);
  behind("apex_radius", options.apex_radius, "joint_radius", options.joint_radius);
}

/// The tips are given once.
void check_tips(Reader& reader, const Node& node, const Options& options) {
  const Node *length = node.find("fork_length"), *radius = node.find("tip_radius");
  if ((length == nullptr) == (radius == nullptr)) {
    reader.complain(radius == nullptr ? node.label : radius->label,
                    radius == nullptr ? "the tips are not given" : "the tips are given twice",
                    reader.context(), "expected exactly one of: fork_length, tip_radius");
    return;
  }
  if (radius == nullptr || options.tip_radius.empty()) return;
  const auto n = static_cast<int>(options.tip_radius.size());
  if (n != 1 && n != options.spokes)
    reader.complain(*radius, fmt::format("tip_radius has {} numbers for {} spokes", n, options.spokes),
                    fmt::format("expected one number for all, or {}", options.spokes));
  const double least = *std::min_element(options.tip_radius.begin(), options.tip_radius.end());
  if (node.find("apex_radius") != nullptr && least <= options.apex_radius)
    reader.complain(*radius,
                    fmt::format("tip_radius = {} is not outside apex_radius = {}", format_number(least),
                                format_number(options.apex_radius)),
                    fmt::format("expected more than {} [m]", format_number(options.apex_radius)));
}

template <class Builder>
void add_spoke_keys(Builder& b) {
  b.key("spokes", &Options::spokes)
      .at_least(5)
      .says("Number of spokes, evenly spread, the first towards +x.");
  b.key("hub_radius", &Options::hub_radius)
      .in("m")
      .above(0)
      .required()
      .says("Where the spokes and the nets are attached.");
  b.key("joint_radius", &Options::joint_radius)
      .in("m")
      .above(0)
      .required()
      .says("Where a spoke's root link ends and its intermediate link begins.");
  b.key("apex_radius", &Options::apex_radius)
      .in("m")
      .above(0)
      .required()
      .says("Where the intermediate link ends and the fork begins.");
  b.key("fork_length", &Options::fork_length)
      .in("m")
      .above(0)
      .by_default("none; or give `tip_radius`")
      .says("Length of the two links of a fork, from the apex to the tips on the surface and on its mirror.");
  b.key("tip_radius", &Options::tip_radius)
      .in("m")
      .above(0)
      .by_default("none; or give `fork_length`")
      .says("Radius of the tips on the surface: one number for all spokes, or one for each.");
}

using PatternWords = std::vector<std::pair<std::string, reflector::NetPattern>>;

const PatternWords& front_patterns() {
  using enum reflector::NetPattern;
  static const PatternWords words{{"triangles", triangles},
                                  {"belts", belts},
                                  {"rectangles", rectangles},
                                  {"right_triangles", right_triangles}};
  return words;
}

const PatternWords& rear_patterns() {
  static const PatternWords words = [] {
    auto all = front_patterns();
    all.emplace_back("coarse_triangles", reflector::NetPattern::coarse_triangles);
    return all;
  }();
  return words;
}

/// The rear net has a node under each of the front net, so not every pattern fits under every other.
void check_patterns(Reader& reader, const Node& node, const Options& options) {
  using enum reflector::NetPattern;
  const Node* pattern = node.find("rear_pattern");
  if (pattern == nullptr || !options.rear_pattern) return;
  const auto rear = *options.rear_pattern;
  if (rear == options.front_pattern || rear == belts) return;
  if (rear != coarse_triangles || options.front_pattern != triangles)
    reader.complain(*pattern, "rear_pattern does not fit under front_pattern",
                    "expected the same, belts, or under triangles coarse_triangles");
  else if (options.rings % 2 == 1)
    reader.complain(*pattern,
                    fmt::format("coarse_triangles needs an even number of rings, not {}", options.rings),
                    "every second ring of the front net is one of the rear net");
}

template <class Builder>
void add_net_keys(Builder& b) {
  b.key("rings", &Options::rings)
      .at_least(3)
      .at_most(1000)
      .says("Rings of the net; ring k of triangles has k parts between two spokes.");
  b.choice("front_pattern", &Options::front_pattern, front_patterns())
      .says(
          "What the cords of the front net make between two spokes. triangles: isosceles ones; belts: "
          "tangential cords, and cords along the spokes only; rectangles: belts, and columns of cords "
          "parallel to the bisector of the spokes; right_triangles: rectangles with a diagonal each. "
          "Patterns "
          "other than triangles have their rings as groups of their own, and end cords.");
  b.choice("rear_pattern", &Options::rear_pattern, rear_patterns())
      .by_default("front_pattern")
      .says(
          "The same of the rear net, which has a node under each of the front net: as in front, belts, or "
          "(under triangles, an even number of rings) coarse_triangles of twice the side.");
  b.key("separate_rings", &Options::separate_rings)
      .says(
          "The rings are groups front_rings and rear_rings of their own. With more than six spokes they need "
          "more tension than the rest of the net.");
  b.key("surface_height", &Options::surface_height)
      .in("m")
      .says("The surface is raised so far; the plane of the spokes, z = 0, mirrors front and rear net.");
  b.key("cord_sag", &Options::cord_sag)
      .at_least(0)
      .below(0.5)
      .says("Before form-finding: sag of the peripheral cord between two tips over its span.");
  b.key("ring_sag", &Options::ring_sag)
      .at_least(0)
      .below(0.5)
      .by_default("cord_sag with triangles, else 0")
      .says(
          "Before form-finding: sag of the last ring between two spokes over its span; that of the others "
          "grows "
          "evenly from the hub. 0: straight rings.");
  b.key("last_ring", &Options::last_ring)
      .above(0)
      .below(1)
      .says("Before form-finding: radius of the last ring on a spoke over that of the tip.");
  b.key("end_cords", &Options::end_cords)
      .says("Cords along the spokes from the nets' last nodes to the tips.");
  b.key("paired_ties", &Options::paired_ties)
      .says("Over the spokes, two ties round the spoke at each node instead of one through it.");
}

}  // namespace

Block umbrella_block() {
  BlockBuilder<Reflector, Options> b(
      "reflector.umbrella", "umbrella",
      "Spokes from a hub, each ending in a fork, that hold two nets joined by ties.");
  add_surface_keys(b);
  add_spoke_keys(b);
  add_net_keys(b);
  b.key("evaluation_radius", &Options::evaluation_radius)
      .in("m")
      .above(0)
      .by_default("all of the cloth")
      .says("The surface error is taken inside this radius.");
  add_frequency_key(b);
  b.check([](Reader& reader, const Node& node, Options& options) {
    check_clearance(reader, node, options);
    check_spoke(reader, node, options);
    check_tips(reader, node, options);
    check_patterns(reader, node, options);
  });
  return b.take();
}

}  // namespace tautline::deck
