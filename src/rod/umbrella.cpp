#include <tautline/rod/umbrella.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

namespace tautline::rod {

namespace {

/// One value for each link, all positive.
VecX for_links(const std::vector<double>& values, int links, const std::string& what) {
  if (values.size() != 1 && static_cast<int>(values.size()) != links)
    throw ModelError(
        fmt::format("{} values of {} for {} links; one or {} are needed", values.size(), what, links, links));
  VecX all(links);
  for (int k = 0; k < links; ++k) {
    all[k] = values.size() == 1 ? values[0] : values[k];
    if (!(all[k] > 0) || !std::isfinite(all[k]))
      throw ModelError(fmt::format("{} of link {} is {}; it must be positive", what, k + 1, all[k]));
  }
  return all;
}

void check(const UmbrellaOptions& options) {
  const auto require = [](bool met, const std::string& sentence) {
    if (!met) throw ModelError(sentence);
  };
  require(options.rods >= 3, fmt::format("{} rods span no surface; at least 3 are needed", options.rods));
  require(options.links >= 1, fmt::format("a rod of {} links has no length", options.links));
  require(options.root_radius >= 0 && options.root_radius > options.root_offset,
          fmt::format("root_radius {} m must be positive and larger than root_offset {} m",
                      options.root_radius, options.root_offset));
  require(std::abs(options.straight_angle) < 90,
          fmt::format("straight_angle {} degree must be between -90 and 90", options.straight_angle));
  require(options.cable.second_slope > 0 && options.cable.knee_strain > 0,
          "knee_strain and second_slope of a cable must be positive");
}

void place_targets(Umbrella& umbrella, double root_radius) {
  const int m = umbrella.rod.links();
  umbrella.target_x.resize(m);
  umbrella.target_y.resize(m);
  umbrella.target_angle.resize(m);
  double x = root_radius;
  for (int k = 0; k < m; ++k) {
    x = umbrella.meridian.advance(x, umbrella.rod.lengths[k]);
    umbrella.target_x[k] = x;
    umbrella.target_y[k] = umbrella.meridian.at(x).value;
    umbrella.target_angle[k] = umbrella.meridian.angle(x);
    if (!std::isfinite(x) || !std::isfinite(umbrella.target_y[k]))
      throw ModelError(fmt::format("the meridian has no point for node {}", k + 1));
  }
}

}  // namespace

Force tension_ratio(const CableOptions& cable, double strain) {
  if (strain < 0) return {};
  const double beyond = strain - cable.knee_strain;
  if (cable.law == CableLaw::linear || beyond <= 0) return {strain, 1};
  return {cable.knee_strain + cable.second_slope * beyond, cable.second_slope};
}

Force Cables::reaction(int k, double x) const {
  const double pull = 2 * stiffness[k] * std::sin(std::numbers::pi / rods);
  const Force ratio = tension_ratio(options, strain(k, x));
  return {pull * ratio.value, pull * ratio.slope / straight_radius[k]};
}

VecX Cables::slopes(const VecX& x, const VecX& reactions) const {
  VecX slopes = VecX::Zero(x.size());
  for (int k = 0; k < x.size(); ++k) {
    const Force ratio = tension_ratio(options, strain(k, x[k]));
    if (ratio.value > 0 && reactions[k] > 0)
      slopes[k] = reactions[k] * ratio.slope / (ratio.value * straight_radius[k]);
  }
  return slopes;
}

VecX stiffness_for(const Cables& cables, const VecX& x, const VecX& reactions) {
  VecX stiffness(x.size());
  for (int k = 0; k < x.size(); ++k) {
    const double ratio = tension_ratio(cables.options, cables.strain(k, x[k])).value;
    stiffness[k] = ratio > 0 && reactions[k] >= 0
                       ? reactions[k] / (2 * ratio * std::sin(std::numbers::pi / cables.rods))
                       : std::numeric_limits<double>::quiet_NaN();
  }
  return stiffness;
}

VecX Umbrella::straight_radius(const VecX& lengths) const {
  VecX radius(lengths.size());
  double along = hinge_radius;
  for (int k = 0; k < lengths.size(); ++k) {
    along += lengths[k];
    radius[k] = along * std::cos(straight_angle);
  }
  return radius;
}

Root Umbrella::root_at(double turn) const {
  const Root& stop = rod.root;
  const auto between = [&](double from, double to) { return (1 - turn) * from + turn * to; };
  return {between(hinge_radius * std::cos(straight_angle), stop.x),
          between(hinge_radius * std::sin(straight_angle), stop.y), between(straight_angle, stop.angle)};
}

Umbrella make_umbrella(const UmbrellaOptions& options) {
  const Umbrella umbrella = make_umbrella(options, Meridian::make(options.meridian));
  const auto& table = options.meridian.x;
  const double first = options.root_radius, last = umbrella.target_x[options.links - 1];
  if (options.meridian.kind == MeridianKind::table && (first < table.front() || last > table.back()))
    throw ModelError(
        fmt::format("the meridian's table goes from x = {:.6g} to {:.6g} m, the rod from {:.6g} to {:.6g} m",
                    table.front(), table.back(), first, last));
  return umbrella;
}

Umbrella make_umbrella(const UmbrellaOptions& options, Meridian meridian) {
  check(options);
  const double a0 = options.root_radius;
  const Rod rod{for_links(options.lengths, options.links, "lengths"),
                for_links(options.bending_stiffness, options.links, "bending_stiffness"),
                {a0, meridian.at(a0).value, meridian.angle(a0)}};
  Umbrella umbrella{
      .meridian = std::move(meridian),
      .rod = rod,
      .cables = {.rods = options.rods, .options = options.cable, .straight_radius = {}, .stiffness = {}},
      .hinge_radius = a0 - options.root_offset,
      .straight_angle = options.straight_angle * std::numbers::pi / 180,
      .target_x = {},
      .target_y = {},
      .target_angle = {}};
  umbrella.cables.straight_radius = umbrella.straight_radius(rod.lengths);
  place_targets(umbrella, a0);
  return umbrella;
}

}  // namespace tautline::rod
