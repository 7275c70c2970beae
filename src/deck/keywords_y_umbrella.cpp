#include <cmath>
#include <deck/builder.hpp>
#include <deck/dish_keys.hpp>
#include <deck/keywords.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using Options = reflector::YUmbrellaOptions;

/// Fork, ring and tip lie one behind the other.
void check_radii(Reader& reader, const Node& node, const Options& options) {
  const auto behind = [&](const char* key, double radius, const char* before, double inner) {
    const Node* value = node.find(key);
    if (value == nullptr || node.find(before) == nullptr || radius > inner) return;
    reader.complain(*value,
                    fmt::format("{} = {} is not outside {} = {}", key, format_number(radius), before,
                                format_number(inner)),
                    fmt::format("expected more than {} [m]", format_number(inner)));
  };
  behind("fork_radius", options.fork_radius, "hub_radius", options.hub_radius);
  behind("ring_radius", options.ring_radius, "fork_radius", options.fork_radius);
  behind("tip_radius", options.tip_radius, "ring_radius", options.ring_radius);
  const double edge = options.aperture / 2;
  if (const Node* tip = node.find("tip_radius"); tip != nullptr && edge > 0 && options.tip_radius > edge)
    reader.complain(*tip,
                    fmt::format("tip_radius = {} is outside the dish", format_number(options.tip_radius)),
                    fmt::format("expected at most aperture/2 = {} [m]", format_number(edge)));
  if (const Node* ring = node.find("ring_radius");
      ring != nullptr && node.find("tip_radius") == nullptr && edge > 0 && options.ring_radius >= edge)
    reader.complain(
        *ring, fmt::format("ring_radius = {} is not inside the tips", format_number(options.ring_radius)),
        fmt::format("expected less than aperture/2 = {} [m]", format_number(edge)));
}

void check_beam_parts(Reader& reader, const Node& node, const Options& options) {
  if (const Node* parts = node.find("beam_parts"); parts != nullptr && options.beam_parts % 2 != 0)
    reader.complain(*parts, fmt::format("beam_parts = {} is odd", options.beam_parts),
                    "expected an even number: a tie holds the middle of each beam");
}

template <class Builder>
void add_spoke_keys(Builder& b) {
  b.key("spokes", &Options::spokes)
      .at_least(3)
      .at_most(1000)
      .says("Number of spokes, evenly spread, the first towards +x.");
  b.key("hub_radius", &Options::hub_radius)
      .in("m")
      .above(0)
      .required()
      .says("Where the spokes and the main radial cords are attached.");
  b.key("fork_radius", &Options::fork_radius)
      .in("m")
      .above(0)
      .required()
      .says("Where the stem of a spoke branches to front and rear.");
  b.key("ring_radius", &Options::ring_radius)
      .in("m")
      .above(0)
      .required()
      .says(
          "Where the branches meet the power ring, on the surface: inside it are cords, outside shaping "
          "beams.");
  b.key("tip_radius", &Options::tip_radius)
      .in("m")
      .above(0)
      .by_default("aperture/2")
      .says(
          "Of the outer cord, at which the spokes end. If less than aperture/2, shaping beams go on from "
          "there to "
          "the edge of the aperture.");
}

template <class Builder>
void add_net_keys(Builder& b) {
  b.key("surface_height", &Options::surface_height)
      .in("m")
      .says("The surface is raised so far; the plane of the stems, z = 0, mirrors front and rear.");
  b.key("rings", &Options::rings)
      .at_least(1)
      .at_most(1000)
      .says("Rings of tangential cords between hub and power ring.");
  b.key("parts", &Options::parts)
      .at_least(2)
      .at_most(1000)
      .says(
          "Parts of power ring and outer cord between two spokes; a shaping beam between each two of them.");
  b.key("beam_parts", &Options::beam_parts)
      .at_least(2)
      .at_most(1000)
      .says("Straight parts of a shaping beam, with their ends on the surface; even.");
  b.key("ring_sag", &Options::ring_sag)
      .at_least(0)
      .below(0.5)
      .says("Sag of the power ring inwards between two spokes over its span, in plan.");
  b.key("rear_ring_sag", &Options::rear_ring_sag)
      .at_least(0)
      .below(0.5)
      .says("Sag of the rear ring between two spokes over its span, towards the outer ends of the beams.");
  b.key("rear_outer_sag", &Options::rear_outer_sag)
      .at_least(0)
      .below(0.5)
      .says(
          "Sag of the rear outer cord between two spokes over its span, towards the inner ends of the "
          "beams.");
}

}  // namespace

Block y_umbrella_block() {
  BlockBuilder<Reflector, Options> b("reflector.y-umbrella", "y-umbrella",
                                     "Spokes from a hub that branch in Y shape and hold a net of radial and "
                                     "tangential cords, which rigid radial "
                                     "beams continue at the periphery; without cloth.");
  add_surface_keys(b);
  add_spoke_keys(b);
  add_net_keys(b);
  add_radius_key(b);
  add_frequency_key(b);
  b.check([](Reader& reader, const Node& node, Options& options) {
    check_clearance(reader, node, options);
    check_radius(reader, node, options);
    check_radii(reader, node, options);
    check_beam_parts(reader, node, options);
  });
  return b.take();
}

}  // namespace tautline::deck
