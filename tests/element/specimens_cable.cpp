#include <tautline/element/cable.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

Specimen cable(const std::string& name, const CableProperties& properties, const Vec3& u_end) {
  Specimen s{name, false, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 3, -2, 1, 0.5, 1;
  s.motion.u << 0.1, u_end[0], -0.2, u_end[1], 0.05, u_end[2];
  s.evaluate = [=, x = s.x_ref](const Motion& m, const std::vector<int>& order, Want want) {
    const auto response = evaluated_over_nan<CableResponse>([&] {
      return evaluate_cable(properties, reordered<2>(x, order), flat<2>(reordered<2>(m.u, order)), want);
    });
    return answer_of(response, want);
  };
  return s;
}

}  // namespace

std::vector<Specimen> cable_specimens() {
  return {cable("CableTaut", {2000, 0.01}, Vec3(0.3, 0.4, -0.2)),
          cable("CableThatStartsSlack", {2000, -0.05}, Vec3(0.9, 0.8, 0.4)),
          cable("BarPulled", {2000, 0.01, true}, Vec3(0.3, 0.4, -0.2)),
          cable("BarPushed", {2000, -0.05, true}, Vec3(-0.3, -0.4, 0.2))};
}

}  // namespace tautline::element
