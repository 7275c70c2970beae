#include <tautline/rod/report.hpp>

#include <cmath>

#include <fmt/format.h>

namespace tautline::rod {

namespace {

/// Simpson's rule over the points of each link; its error is far below the digits shown for smooth links.
RodError error_along(const Meridian& meridian, const RodShape& shape) {
  RodError error;
  double normal = 0, axial = 0;
  const auto& curve = shape.curve;
  for (int i = 0; i < static_cast<int>(curve.size()); ++i) {
    const RodPoint& point = curve[i];
    const double distance = meridian.distance(point.x, point.y), above = point.y - meridian.at(point.x).value;
    const double before = i > 0 ? point.s - curve[i - 1].s : 0;
    const double after = i + 1 < static_cast<int>(curve.size()) ? curve[i + 1].s - point.s : 0;
    const double weight = (i % 2 == 1 ? 2 : 1) * (before + after) / 3;
    normal += weight * distance * distance;
    axial += weight * above * above;
    if (std::abs(distance) > std::abs(error.max)) {
      error.max = distance;
      error.max_at = point.s;
    }
  }
  const double length = curve.empty() ? 1 : curve.back().s;
  error.rms = std::sqrt(normal / length);
  error.rms_axial = std::sqrt(axial / length);
  return error;
}

std::vector<std::string> warn(const Cables& cables, const VecX& strain, const VecX& reaction) {
  std::vector<std::string> warnings, stretched;  // what no cable can do comes first
  for (int k = 0; k < strain.size(); ++k) {
    if (reaction[k] < 0)
      warnings.push_back(fmt::format("node {} must be pushed outwards with {:.4g} N, which no cable can",
                                     k + 1, -reaction[k]));
    else if (strain[k] <= 0 && reaction[k] > 0)
      warnings.push_back(fmt::format("cable {} is slack at strain {:.3g} and cannot pull with {:.4g} N",
                                     k + 1, strain[k], reaction[k]));
    if (strain[k] > cables.options.strain_limit)
      stretched.push_back(fmt::format("cable {} is stretched by {:.1f} %, beyond strain_limit = {:.1f} %",
                                      k + 1, 100 * strain[k], 100 * cables.options.strain_limit));
  }
  warnings.insert(warnings.end(), stretched.begin(), stretched.end());
  return warnings;
}

}  // namespace

RodReport make_report(const Umbrella& umbrella, const RodShape& shape) {
  Cables cables = umbrella.cables;
  cables.straight_radius = umbrella.straight_radius(shape.rod.lengths);
  RodReport report;
  report.strain = shape.x.cwiseQuotient(cables.straight_radius).array() - 1;
  report.stiffness = stiffness_for(cables, shape.x, shape.reaction);
  report.miss_x = shape.x - umbrella.target_x;
  report.miss_y = shape.y - umbrella.target_y;
  report.node_error = shape.y;
  for (int k = 0; k < shape.x.size(); ++k) report.node_error[k] -= umbrella.meridian.at(shape.x[k]).value;
  report.along = error_along(umbrella.meridian, shape);
  report.warnings = warn(cables, report.strain, shape.reaction);
  return report;
}

}  // namespace tautline::rod
