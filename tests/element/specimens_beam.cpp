#include <tautline/element/beam.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

Specimen beam(const std::string& name, const BeamSection& section, double bend, double free_strain = 0) {
  Specimen s{name, true, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 2.5, -2, -1, 0.5, 1;
  s.motion.u << 0.1, 0.13, -0.2, -0.1, 0.05, 0.1;
  s.motion.rotation = {turn(bend * Vec3(0.3, -0.8, 0.5)), turn(bend * Vec3(-0.4, 0.6, 0.7))};
  const Mat<3, 2> x = s.x_ref;
  const Mat3 frame = beam_frame(x, Vec3(0.2, 0.3, 1));
  s.evaluate = [=](const Motion& m, const std::vector<int>& order, Want want) {
    BeamGeometry geometry{reordered<2>(x, order), frame, free_strain};
    if (order[0] == 1) geometry.frame << -frame.col(0), frame.col(1), -frame.col(2);
    const BeamMotion motion{reordered<2>(m.u, order), {m.rotation[order[0]], m.rotation[order[1]]}};
    const auto response =
        evaluated_over_nan<BeamResponse>([&] { return evaluate_beam(section, geometry, motion, want); });
    return answer_of(response, want);
  };
  return s;
}

}  // namespace

std::vector<Specimen> beam_specimens() {
  const BeamSection rigid_in_shear{5000, 30, 20, 10, 0, 0, 1, 1, 1};
  const BeamSection shear_flexible{5000, 30, 20, 10, 400, 300, 1, 1, 1};
  return {beam("BeamSlightlyBent", rigid_in_shear, 1e-3), beam("BeamStronglyBent", rigid_in_shear, 1),
          beam("BeamFlexibleInShear", shear_flexible, 0.7), beam("BeamHeated", shear_flexible, 0.7, 0.2)};
}

}  // namespace tautline::element
