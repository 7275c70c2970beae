#include "detail/beam_local.hpp"

#include <array>

namespace tautline::element::detail {

namespace {

/// @brief One bending plane in the modes c = (b - a)/2 (constant moment) and s = (a + b)/2 (constant shear).
///
/// a, b are the end rotations. With Phi = 12 EI/(kGA L^2) the energy is EI/(2 L) (4 c^2 + 12 s^2/(1 + Phi))
/// and the mean of v'^2/2 along the beam c^2/6 + s^2/(10 (1 + Phi)^2). Below: the second derivatives by c and
/// s.
struct Plane {
  int a, b;                           ///< places of the end rotations among the local deformations
  double c, s;                        ///< the modes [rad]
  double stiffness_c, stiffness_s;    ///< of the energy [N m]
  double shortening_c, shortening_s;  ///< of the mean of v'^2/2
};

/// Bending by rotation about local `axis` (2 or 3).
Plane bending(int axis, double bending_stiffness, double shear_stiffness, double length,
              const Vec<7>& deformation) {
  const double phi = shear_stiffness > 0 ? 12 * bending_stiffness / (shear_stiffness * length * length) : 0;
  const double a = deformation[axis];
  const double b = deformation[axis + 3];
  return {axis,
          axis + 3,
          (b - a) / 2,
          (b + a) / 2,
          4 * bending_stiffness / length,
          12 * bending_stiffness / (length * (1 + phi)),
          1. / 3,
          1. / (5 * (1 + phi) * (1 + phi))};
}

double quadratic(const Plane& plane, double k_c, double k_s) {
  return (k_c * plane.c * plane.c + k_s * plane.s * plane.s) / 2;
}

void add_gradient(const Plane& plane, double k_c, double k_s, Vec<7>& gradient) {
  gradient[plane.a] += (k_s * plane.s - k_c * plane.c) / 2;
  gradient[plane.b] += (k_s * plane.s + k_c * plane.c) / 2;
}

void add_hessian(const Plane& plane, double k_c, double k_s, Mat<7>& hessian) {
  hessian(plane.a, plane.a) += (k_s + k_c) / 4;
  hessian(plane.b, plane.b) += (k_s + k_c) / 4;
  hessian(plane.a, plane.b) += (k_s - k_c) / 4;
  hessian(plane.b, plane.a) += (k_s - k_c) / 4;
}

using Planes = std::array<Plane, 2>;

Planes bending_planes(const BeamSection& section, double length, const Vec<7>& deformation) {
  return {bending(2, section.bending_stiffness_2, section.shear_stiffness_3, length, deformation),
          bending(3, section.bending_stiffness_3, section.shear_stiffness_2, length, deformation)};
}

/// Of the axial strain, by the local deformations.
Vec<7> axial_strain_gradient(const Planes& planes, double length) {
  Vec<7> gradient = Vec<7>::Unit(0) / length;
  for (const Plane& plane : planes) add_gradient(plane, plane.shortening_c, plane.shortening_s, gradient);
  return gradient;
}

/// Moments of bending and torsion, without axial force.
BeamStress moments(const Planes& bent, double torsion, double twist) {
  BeamStress result = BeamStress::Zero();
  result[1] = -torsion * twist;
  result[4] = torsion * twist;
  for (const Plane& plane : bent) add_gradient(plane, plane.stiffness_c, plane.stiffness_s, result);
  return result;
}

/// Adds a symmetric 4x4 matrix for (deflection 1, slope 1, deflection 2, slope 2) to the places given.
void add_plane(const Mat<4>& plane, const std::array<int, 4>& places, double slope_sign, Mat<12>& matrix) {
  const std::array<double, 4> sign{1, slope_sign, 1, slope_sign};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(places[i], places[j]) += sign[i] * sign[j] * plane(i, j);
}

/// Adds the mass of a linearly interpolated motion, total mass `m`.
void add_linear(double m, int i, int j, Mat<12>& matrix) {
  matrix(i, i) += m / 3;
  matrix(j, j) += m / 3;
  matrix(i, j) += m / 6;
  matrix(j, i) += m / 6;
}

/// Mass of bending in one plane: translation of the cubic, rotation of the sections. Where the beam shears
/// the sections do not turn with the slope of the cubic: their rotation goes linearly between the ends, else
/// the inertia of the shear angle would be counted, too, however short the elements.
Mat<4> bending_mass(double mass_per_length, double rotary_inertia, bool shears, double L) {
  Mat<4> translation, rotation;
  translation << 156, 22 * L, 54, -13 * L,    //
      22 * L, 4 * L * L, 13 * L, -3 * L * L,  //
      54, 13 * L, 156, -22 * L,               //
      -13 * L, -3 * L * L, -22 * L, 4 * L * L;
  rotation << 36, 3 * L, -36, 3 * L,     //
      3 * L, 4 * L * L, -3 * L, -L * L,  //
      -36, -3 * L, 36, -3 * L,           //
      3 * L, -L * L, -3 * L, 4 * L * L;
  if (shears) {
    rotation.setZero();
    rotation(1, 1) = rotation(3, 3) = 10 * L * L;
    rotation(1, 3) = rotation(3, 1) = 5 * L * L;
  }
  return mass_per_length * L / 420 * translation + rotary_inertia / (30 * L) * rotation;
}

}  // namespace

BeamLocalResponse beam_local_law(const BeamSection& section, double length, double free_strain,
                                 const Vec<2>& free_curvature, const Vec<7>& deformation, Want want,
                                 const BeamStress* instead) {
  const auto planes = bending_planes(section, length, deformation);
  double strain = deformation[0] / length - free_strain;  // the part that makes force
  for (const Plane& plane : planes) strain += quadratic(plane, plane.shortening_c, plane.shortening_s);
  const Vec<7> strain_gradient = axial_strain_gradient(planes, length);
  const double torsion = section.torsion_stiffness / length;
  const double twist = deformation[4] - deformation[1];

  BeamLocalResponse local;
  local.energy = (section.axial_stiffness * strain * strain * length + torsion * twist * twist) / 2;
  auto bent = planes;  // what is left of the bending makes moment
  for (Plane& plane : bent) {
    plane.c -= free_curvature[plane.a - 2] * length / 2;
    local.energy += quadratic(plane, plane.stiffness_c, plane.stiffness_s);
  }
  local.stress = moments(bent, torsion, twist);
  local.stress[0] = section.axial_stiffness * strain;
  if (instead) local.stress = *instead;
  const double axial = local.stress[0] * length;  // d energy / d strain
  local.force = axial * strain_gradient;
  local.force.tail<6>() += local.stress.tail<6>();
  if (want == Want::force) return local;

  local.tangent = section.axial_stiffness * length * strain_gradient * strain_gradient.transpose();
  local.tangent(1, 1) += torsion;
  local.tangent(4, 4) += torsion;
  local.tangent(1, 4) -= torsion;
  local.tangent(4, 1) -= torsion;
  for (const Plane& plane : planes)
    add_hessian(plane, plane.stiffness_c + axial * plane.shortening_c,
                plane.stiffness_s + axial * plane.shortening_s, local.tangent);
  return local;
}

BeamStress beam_local_stress_rate(const BeamSection& section, double length, const Vec<7>& deformation,
                                  const Vec<7>& change) {
  const auto planes = bending_planes(section, length, deformation);
  BeamStress rate = moments(bending_planes(section, length, change), section.torsion_stiffness / length,
                            change[4] - change[1]);
  rate[0] = section.axial_stiffness * axial_strain_gradient(planes, length).dot(change);
  return rate;
}

Mat<12> beam_local_mass(const BeamSection& section, double length) {
  const double polar = section.rotary_inertia_2 + section.rotary_inertia_3;
  Mat<12> mass = Mat<12>::Zero();
  add_linear(section.mass_per_length * length, 0, 6, mass);
  add_linear(polar * length, 3, 9, mass);
  // v' = +rotation about 3, w' = -rotation about 2
  const auto plane = [&](double rotary_inertia, double shear_stiffness) {
    return bending_mass(section.mass_per_length, rotary_inertia, shear_stiffness > 0, length);
  };
  add_plane(plane(section.rotary_inertia_3, section.shear_stiffness_2), {1, 5, 7, 11}, 1, mass);
  add_plane(plane(section.rotary_inertia_2, section.shear_stiffness_3), {2, 4, 8, 10}, -1, mass);
  return mass;
}

}  // namespace tautline::element::detail
