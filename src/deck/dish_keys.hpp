#pragma once
/// @file
/// Keys that the reflectors of nets and ties share, of reflector::DishOptions.

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
void add_frequency_key(Builder& b) {
  b.key("frequency", &reflector::DishOptions::frequency)
      .in("Hz")
      .at_least(0)
      .says("Frequency for the gain loss; 0: none.");
}

/// Complains about a clearance outside the dish.
void check_clearance(Reader& reader, const Node& node, const reflector::DishOptions& options);

}  // namespace tautline::deck
