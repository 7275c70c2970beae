#pragma once
/// @file
/// Keys that the reflectors of nets and ties share, of reflector::DishOptions and TriangularNetOptions.

#include <deck/builder.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

template <class Builder>
void add_surface_keys(Builder& b) {
  using Options = reflector::DishOptions;
  b.key("aperture", &Options::aperture)
      .in("m")
      .above(0)
      .required()
      .also_called({"diameter", "D"})
      .says("Diameter D of the aperture.");
  b.key("focal_length", &Options::focal_length)
      .in("m")
      .above(0)
      .required()
      .also_called({"focus", "F", "f"})
      .says("Focal length F of the parent paraboloid.");
  b.key("clearance", &Options::clearance)
      .in("m")
      .by_default("-aperture/2 (axisymmetric dish)")
      .also_called({"offset"})
      .says("Distance from the parent axis to the near edge of the dish; at least -aperture/2.");
}

template <class Builder>
void add_triangular_net_keys(Builder& b) {
  using Options = reflector::TriangularNetOptions;
  b.key("rings", &Options::rings)
      .at_least(1)
      .at_most(1000)
      .says("Rings of triangles in the net; the rim has 6 x rings nodes.");
  b.key("gap", &Options::gap).in("m").at_least(0).says("Extra distance between front and rear net.");
  b.key("rim_height", &Options::rim_height)
      .in("m")
      .by_default("highest point of the surface over the rim")
      .says("Height z of the plane on whose circle the front net hangs.");
}

template <class Builder>
void add_radius_key(Builder& b) {
  b.key("evaluation_radius", &reflector::DishOptions::evaluation_radius)
      .in("m")
      .above(0)
      .by_default("all of the surface")
      .says("The surface error is taken inside this radius; at most aperture/2.");
}

template <class Builder>
void add_frequency_key(Builder& b) {
  b.key("frequency", &reflector::DishOptions::frequency)
      .in("Hz")
      .at_least(0)
      .says("Frequency for the gain loss; 0: none.");
}

/// Complains about a clearance outside the dish.
void check_clearance(Reader& reader, const Node& node, const reflector::DishOptions& options);
/// Complains about an evaluation_radius outside the dish.
void check_radius(Reader& reader, const Node& node, const reflector::DishOptions& options);

}  // namespace tautline::deck
