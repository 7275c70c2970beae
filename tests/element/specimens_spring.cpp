#include <tautline/element/spring.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

/// Both nodes at the same place at first; `opening` [m] and `turning` [rad] between them.
Specimen spring(const std::string& name, double opening, double turning) {
  Specimen s{name, true, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 1, -2, -2, 0.5, 0.5;
  const Vec3 u1(0.1, -0.2, 0.05);
  s.motion.u << u1, u1 + opening * Vec3(0.5, -0.7, 0.4);
  const Mat3 R1 = turn(Vec3(0.3, -0.8, 0.5));
  s.motion.rotation = {R1, turn(turning * Vec3(-0.4, 0.6, 0.7)) * R1};
  const SpringProperties properties{{300, 200, 50}, {30, 10, 20}};
  s.evaluate = [=](const Motion& m, const std::vector<int>& order, Want want) {
    const SpringMotion motion{reordered<2>(m.u, order), {m.rotation[order[0]], m.rotation[order[1]]}};
    const auto response =
        evaluated_over_nan<SpringResponse>([&] { return evaluate_spring(properties, motion, want); });
    return answer_of(response, want);
  };
  s.may_reverse_nodes = false;  // the axes turn with the first node
  return s;
}

}  // namespace

std::vector<Specimen> spring_specimens() {
  return {spring("SpringSlightlyMoved", 1e-3, 1e-3), spring("SpringFarOpenAndTurned", 1, 2)};
}

}  // namespace tautline::element
