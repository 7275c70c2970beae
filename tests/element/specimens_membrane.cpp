#include <array>
#include <cmath>

#include <tautline/element/membrane.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

const MembraneSection isotropic{1000, 0.3, 0};
const MembraneSection woven{1000, 0.3, 0, 400, 150, 1e-4, 3e-4};

MembraneSection wrinkling(MembraneSection section) {
  section.wrinkling = true;
  return section;
}

/// The law that belongs to a frame; `given` is the frame in which prestress and material axis were stated.
MembraneLaw law_in(const Mat3& frame, const Mat3& given, const MembraneSection& section,
                   const Vec3& prestress) {
  const Mat<2> Q = frame.leftCols<2>().transpose() * given.leftCols<2>();
  Mat<2> tensor;
  tensor << prestress[0], prestress[2], prestress[2], prestress[1];
  const Mat<2> N = Q * tensor * Q.transpose();
  const Vec<2> axis = Q * Vec<2>(std::cos(0.4), std::sin(0.4));
  return membrane_law(section, std::atan2(axis[1], axis[0]), Vec3(N(0, 0), N(1, 1), N(0, 1)), 50);
}

template <int N>
Specimen membrane(const std::string& name, const MembraneSection& section, const Vec3& prestress,
                  const Mat<3, N>& x, const Mat<3, N>& u) {
  Specimen s{name, false, x, {u, {}}, {}};
  s.evaluate = [=](const Motion& m, const std::vector<int>& order, Want want) {
    const Mat<3, N> nodes = reordered<N>(x, order);
    const auto law = law_in(membrane_frame<N>(nodes), membrane_frame<N>(x), section, prestress);
    const auto response = evaluated_over_nan<MembraneResponse<N>>(
        [&] { return evaluate_membrane<N>(law, nodes, flat<N>(reordered<N>(m.u, order)), want); });
    return answer_of(response, want);
  };
  return s;
}

Specimen triangle(const std::string& name, const MembraneSection& section, const Vec3& prestress) {
  Mat<3, 3> x, u;
  x << 0, 1.2, 0.3, 0.1, 0.2, 0.9, 0, 0.3, -0.2;
  u << 0.05, -0.1, 0.2, 0.03, 0.15, -0.07, 0.1, -0.12, 0.21;
  return membrane<3>("MembraneTriangle" + name, section, prestress, x, u);
}

/// Not flat.
Specimen quadrilateral(const std::string& name, const MembraneSection& section, const Vec3& prestress) {
  Mat<3, 4> x, u;
  x << 0, 1.2, 1.4, 0.3, 0.1, 0.2, 1.1, 0.9, 0, 0.3, -0.1, -0.2;
  u << 0.05, -0.1, 0.04, 0.2, 0.03, 0.15, -0.11, -0.07, 0.1, -0.12, 0.05, 0.21;
  return membrane<4>("MembraneQuadrilateral" + name, section, prestress, x, u);
}

}  // namespace

std::vector<Specimen> membrane_specimens() {
  const Vec3 none = Vec3::Zero(), prestress(40, 70, 25);
  std::vector<Specimen> all;
  for (const auto& shape : {triangle, quadrilateral}) {
    all.push_back(shape("Elastic", isotropic, none));
    all.push_back(shape("Prestressed", isotropic, prestress));
    all.push_back(shape("OfPrestressAlone", MembraneSection{}, prestress));
    all.push_back(shape("Woven", woven, prestress));
    all.push_back(shape("Wrinkled", wrinkling(isotropic), prestress));
    all.push_back(shape("WovenWrinkled", wrinkling(woven), prestress));
  }
  // both sides of the two switches, as close as the steps of the ladder allow
  const Vec3 near_taut(170, 170, 20), near_slack(-12, -12, 0);
  all.push_back(triangle("WovenAlmostWrinkled", wrinkling(woven), near_taut));
  all.push_back(triangle("WovenHardlyWrinkled", wrinkling(woven), near_taut - Vec3(25, 25, 0)));
  all.push_back(triangle("AlmostSlack", wrinkling(isotropic), near_slack));
  all.push_back(quadrilateral("WovenAlmostWrinkled", wrinkling(woven), near_taut + Vec3(35, 35, 0)));
  all.push_back(quadrilateral("WovenHardlyWrinkled", wrinkling(woven), near_taut - Vec3(35, 35, 0)));
  all.push_back(quadrilateral("AlmostSlack", wrinkling(isotropic), near_slack + Vec3(60, 60, 0)));
  return all;
}

}  // namespace tautline::element
