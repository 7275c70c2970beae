#include <tautline/element/catenary.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

Specimen catenary(const std::string& name, const CatenaryProperties& properties, const Vec3& acceleration) {
  Specimen s{name, false, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 3, -2, 1, 0.5, 1;
  s.motion.u << 0.1, 0.3, -0.2, 0.4, 0.05, -0.2;  // chord (2.2, 3.6, 0.25), 4.226 m
  s.evaluate = [=, x = s.x_ref](const Motion& m, const std::vector<int>& order, Want want) {
    const auto response = evaluated_over_nan<CatenaryResponse>([&] {
      return evaluate_catenary(properties, acceleration, reordered<2>(x, order),
                               flat<2>(reordered<2>(m.u, order)), want);
    });
    return answer_of(response, want);
  };
  s.field_force =
      properties.unstressed_length * (properties.mass_per_length * acceleration + properties.line_load);
  s.in_turned_field = [=](const Mat3& Q) {
    CatenaryProperties turned = properties;
    turned.line_load = Q * properties.line_load;
    return catenary(name, turned, Q * acceleration);
  };
  return s;
}

}  // namespace

std::vector<Specimen> catenary_specimens() {
  const Vec3 oblique(2, -4, -8);
  return {catenary("CatenaryTaut", {2000, 4, 0.5}, oblique),
          catenary("CatenarySlack", {2000, 7, 0.5}, oblique),
          catenary("CatenaryOfItsChordsLength", {200, 4.226, 2}, oblique),
          catenary("CatenaryHangingSteeply", {200, 4, 2}, Vec3(4.5, 7, 0.2)),
          catenary("CatenaryUnderWeightAndWind", {200, 4.5, 0.5, Vec3(1, -2, 3)}, oblique),
          catenary("CatenaryWithoutWeight", {2000, 4, 0}, oblique)};
}

}  // namespace tautline::element
