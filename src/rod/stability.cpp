#include <tautline/rod/stability.hpp>

#include <cmath>

#include <Eigen/Eigenvalues>

namespace tautline::rod {

namespace {

/// Second variation on hat functions of the angle, two intervals of the curve wide, held at the root.
struct SecondVariation {
  MatX bending, load;
  MatX radius;  ///< column k: dX of node k by the angles
};

/// Simpson's rule on each element, exact for products of hat functions.
void add_link(const RodShape& shape, int k, double axial_force, SecondVariation& out) {
  const int elements = intervals_per_link / 2;
  const double h = shape.rod.lengths[k] / elements;
  for (int e = 0; e < elements; ++e) {
    const int left = k * elements + e;  // hat functions left - 1 and left, the first of all is held
    const RodPoint* point = &shape.curve[2 * left];
    for (int g = 0; g < 3; ++g) {
      const double weight = h * (g == 1 ? 4 : 1) / 6, angle = point[g].angle;
      const double value[2] = {1 - g / 2.0, g / 2.0};
      for (int i = left == 0 ? 1 : 0; i < 2; ++i) {
        const int row = left - 1 + i;
        out.radius.row(row).tail(shape.rod.links() - k).array() -= weight * value[i] * std::sin(angle);
        for (int j = left == 0 ? 1 : 0; j < 2; ++j)
          out.load(row, left - 1 + j) += weight * axial_force * std::cos(angle) * value[i] * value[j];
      }
    }
    for (int i = left == 0 ? 1 : 0; i < 2; ++i)
      for (int j = left == 0 ? 1 : 0; j < 2; ++j)
        out.bending(left - 1 + i, left - 1 + j) += (i == j ? 1 : -1) * shape.rod.bending_stiffness[k] / h;
  }
}

}  // namespace

Stability compare_forms(const MatX& energy, const MatX& bending) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> modes(energy, bending, Eigen::EigenvaluesOnly);
  return {static_cast<int>((modes.eigenvalues().array() < 0).count()), modes.eigenvalues()[0]};
}

Stability judge_stability(const RodShape& shape, const VecX& slopes) {
  const int m = shape.rod.links(), n = m * intervals_per_link / 2;
  SecondVariation variation{MatX::Zero(n, n), MatX::Zero(n, n), MatX::Zero(n, m)};
  const VecX axial_force = shape.axial_force();
  for (int k = 0; k < m; ++k) add_link(shape, k, axial_force[k], variation);
  const MatX cables = variation.radius * slopes.asDiagonal() * variation.radius.transpose();
  return compare_forms(variation.bending - variation.load + cables, variation.bending);
}

}  // namespace tautline::rod
