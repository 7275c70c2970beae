#include <tautline/element/catenary.hpp>

#include <algorithm>
#include <cmath>

#include "detail/catenary_integrals.hpp"
#include "detail/chord.hpp"

namespace tautline::element {

namespace {

using detail::CatenaryIntegrals;

/// A cable between two ends in the plane of its chord and its weight, other loads along it included.
struct Plane {
  double length;       ///< unstressed [m]
  double chord;        ///< [m]
  double elongation;   ///< chord - length, without cancellation in the displacements [m]
  double elasticity;   ///< 1/EA [1/N]
  Mat<3, 2> axes;      ///< columns n along the chord, p across
  Vec3 weight_global;  ///< per unstressed length [N/m]
  detail::PlaneWeight w;
};

/// Part of v normal to the unit vector n; twice, so that what is left of an almost parallel v is normal, too.
Vec3 normal_part(const Vec3& v, const Vec3& n) {
  const Vec3 once = v - n * n.dot(v);
  return once - n * n.dot(once);
}

Plane plane_of(const CatenaryProperties& properties, const Vec3& acceleration, const Mat<3, 2>& x_ref,
               const Vec<6>& u) {
  const detail::Chord chord = detail::chord(x_ref, u.head<3>(), u.tail<3>());
  Plane c;
  c.length = properties.unstressed_length;
  c.chord = chord.length;
  const bool closed = chord.length_ref + chord.length == 0;  // a loop from one point, before and after
  c.elongation = (chord.length_ref - c.length) + (closed ? 0 : chord.elongation);
  c.elasticity = 1 / properties.axial_stiffness;
  c.weight_global = properties.mass_per_length * acceleration + properties.line_load;
  c.w.size = c.weight_global.norm();
  // Where the ends meet any axis will do; one across the weight is the limit of a closing loop.
  const Vec3 n = chord.length > 0 ? chord.direction
                 : c.w.size > 0   ? c.weight_global.unitOrthogonal().eval()
                                  : Vec3::UnitX().eval();
  const Vec3 across = normal_part(c.weight_global, n);
  const bool plumb = across.norm() <= 1e-15 * c.w.size;
  c.axes << n, plumb ? n.unitOrthogonal().eval() : across.normalized().eval();
  c.w.part << n.dot(c.weight_global), plumb ? 0 : across.norm();
  return c;
}

/// Neither weight nor stretch gives the cable a shape.
bool is_loose(const Plane& c) {
  return c.w.size == 0 && c.elongation <= 0;
}

/// Chord of the ends minus that of a cable with the tension vector `force` in its middle [m].
Vec<2> gap(const Plane& c, const Vec<2>& force, const CatenaryIntegrals& sum) {
  return Vec<2>(c.elongation, 0) - c.length * c.elasticity * force + sum.deficit;
}

/// Change of the chord by the tension vector in the middle, symmetric and positive definite [m/N].
Mat<2> flexibility(const Plane& c, const CatenaryIntegrals& sum) {
  return sum.flexibility + c.length * c.elasticity * Mat<2>::Identity();
}

Mat<2> inverse_of(const Mat<2>& m) {
  Mat<2> adjugate;
  adjugate << m(1, 1), -m(0, 1), -m(0, 1), m(0, 0);
  return adjugate / (m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1));
}

double smallest_tension(const Plane& c, const Vec<2>& force) {
  const double middle = force.dot(c.w.part) / (c.w.size * c.w.size);
  const double sigma = std::clamp(middle, -c.length / 2, c.length / 2);
  return (force - sigma * c.w.part).norm();
}

/// The step leaves rounding: the error after it is about its square over the tension, across the chord of a
/// shallow cable over the weight, which makes its sag.
bool is_last(const Plane& c, const Vec<2>& force, const Vec<2>& step) {
  const double along = smallest_tension(c, force);
  const double across = std::min(along, c.w.part[1] * c.length);
  return (std::abs(step[0]) <= 1e-8 * along && std::abs(step[1]) <= 1e-8 * across) ||
         step.norm() <= 1e-15 * (force.norm() + c.w.size * c.length);
}

/// @brief Tension of a shallow cable: its chord feels weight across only.
///
/// T/EA - (w_p L)^2/(24 T^2) = elongation/L, by Newton's method from above, where it converges monotonically.
double shallow_tension(const Plane& c) {
  const double strain = c.elongation / c.length;
  const double shortening = std::pow(c.w.part[1] * c.length * c.elasticity, 2) / 24;
  double x = std::max(strain, 0.) + std::cbrt(shortening);  // T/EA
  if (strain < 0) x = std::min(x, std::sqrt(shortening / -strain));
  for (int i = 0; i < 3 && x > 0; ++i) x -= (x * x * (x - strain) - shortening) / (x * (3 * x - 2 * strain));
  return x / c.elasticity;
}

/// @brief Middle tension of an inextensible catenary, chord below its length.
///
/// With lambda = w d_e/(2 H), d_e and d_g the chord across and along the weight: sinh(lambda)/lambda =
/// sqrt(L^2 - d_g^2)/d_e and P = w d_g coth(lambda)/2. Source: Jayaraman & Knudson (1981). For lambda a
/// formula that joins the limits of small and large sag, wrong by less than 5 %.
Vec<2> slack_tension(const Plane& c) {
  const Vec<2> n(c.w.part[1] / c.w.size, c.w.part[0] / c.w.size);  // the chord across and along the weight
  const double across = std::max(c.chord * n[0], 1e-20 * c.length);
  const double log_ratio = std::log1p(-c.elongation * (c.length + c.chord) / (across * across)) / 2;
  const double lambda = std::sqrt(log_ratio * (6 + log_ratio));
  const double H = c.w.size * across / (2 * lambda);
  const double P = c.w.size * c.chord * n[1] / (2 * std::tanh(lambda));
  return {H * n[0] + P * n[1], P * n[0] - H * n[1]};
}

Vec<2> first_guess(const Plane& c) {
  const double shallow = shallow_tension(c);
  const double weight = c.w.size * c.length;
  if (shallow >= weight / 2) return {shallow, 0};
  if (c.elongation < 0) return slack_tension(c);
  return {weight / 2, 0};
}

/// @brief Tension vector in the middle of a cable that is not loose, along n and p [N].
///
/// Newton's method on the complementary energy, which is convex; a step that overshoots is halved.
Vec<2> middle_tension(const Plane& c) {
  if (c.w.size == 0) return {c.elongation / (c.length * c.elasticity), 0};
  Vec<2> force = first_guess(c);
  CatenaryIntegrals sum = catenary_integrals(c.w, force, c.length);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vec<2> rest = gap(c, force, sum);
    const Vec<2> step = inverse_of(flexibility(c, sum)) * rest;
    if (is_last(c, force, step)) return force + step;
    const double slope = step.dot(rest);
    double part = 1;
    Vec<2> trial = force + step;
    sum = catenary_integrals(c.w, trial, c.length);
    while (step.dot(gap(c, trial, sum)) < -slope / 2 && part > 1e-16) {
      part /= 2;
      trial = force + part * step;
      sum = catenary_integrals(c.w, trial, c.length);
    }
    force = trial;
  }
  return force;
}

/// A cable at rest between its ends.
struct Hanging {
  Plane plane;
  Vec<2> force;  ///< tension vector in the middle, along n and p [N]
  CatenaryIntegrals sum;
};

Hanging hang(const Plane& plane) {
  const Vec<2> force = middle_tension(plane);
  return {plane, force, catenary_integrals(plane.w, force, plane.length)};
}

/// From the first end to the point at the unstressed length s [m].
Vec3 place(const Hanging& cable, double s) {
  const Plane& c = cable.plane;
  const Vec<2> middle = cable.force + (c.length - s) / 2 * c.w.part;
  const CatenaryIntegrals sum = catenary_integrals(c.w, middle, s);
  return c.axes * (Vec<2>(s, 0) - sum.deficit + s * c.elasticity * middle);
}

/// @brief Largest distance from the chord along the weight, where the tangent is parallel to the chord.
///
/// There t_p = w_p (s* - s) vanishes, and s* is the mean of s with the weights 1/T + 1/EA, since the cable
/// ends on the chord; the distance is w times the integral of (s* - s)(1/T + 1/EA) from the first end to s*.
double sag(const Hanging& cable) {
  const Plane& c = cable.plane;
  const double middle = cable.sum.inverse_moment / (cable.sum.inverse + c.length * c.elasticity);
  const double s = c.length / 2 + middle;
  const Vec<2> force = cable.force + (c.length - s) / 2 * c.w.part;
  const CatenaryIntegrals sum = catenary_integrals(c.w, force, s);
  return c.w.size * (s / 2 * (sum.inverse + s * c.elasticity) - sum.inverse_moment);
}

/// Stiffness of the second end against the first, the inverse of the flexibility.
Mat3 stiffness(const Hanging& cable) {
  const Plane& c = cable.plane;
  const Mat<2> in_plane = inverse_of(flexibility(c, cable.sum));
  const double out_of_plane = 1 / (cable.sum.inverse + c.length * c.elasticity);
  const Vec3 normal = c.axes.col(0).cross(c.axes.col(1));
  const Mat3 block = c.axes * in_plane * c.axes.transpose() + out_of_plane * normal * normal.transpose();
  return (block + block.transpose()) / 2;
}

/// Elastic energy minus work of the weight on displacements from the middle of the chord.
double energy_about_middle(const Hanging& cable) {
  const Plane& c = cable.plane;
  const double weight = c.w.size * c.length;
  const double stretch = c.length * c.elasticity / 2 * (cable.force.squaredNorm() - weight * weight / 12);
  return stretch - cable.force.dot(cable.sum.deficit) - cable.sum.excess;
}

}  // namespace

CatenaryResponse evaluate_catenary(const CatenaryProperties& properties, const Vec3& acceleration,
                                   const Mat<3, 2>& x_ref, const Vec<6>& u, Want want) {
  const Plane plane = plane_of(properties, acceleration, x_ref, u);
  CatenaryResponse response;
  response.length = plane.length;
  response.slack = plane.elongation <= 0;
  response.force.setZero();
  if (want == Want::tangent) response.tangent.setZero();
  if (is_loose(plane)) return response;

  const Hanging cable = hang(plane);
  const Vec3 force = plane.axes * cable.force;
  const Vec3 half_weight = plane.length / 2 * plane.weight_global;
  const Vec3 middle = (x_ref.col(0) + x_ref.col(1) + u.head<3>() + u.tail<3>()) / 2;
  response.energy = energy_about_middle(cable) - 2 * half_weight.dot(middle);
  response.force << -force - half_weight, force - half_weight;
  if (want == Want::tangent) {
    const Mat3 block = stiffness(cable);
    response.tangent << block, -block, -block, block;
  }
  response.tension_start = (force + half_weight).norm();
  response.tension_end = (force - half_weight).norm();
  response.length += plane.elasticity * (cable.sum.excess + plane.length * cable.force[0]);
  response.sag = sag(cable);
  return response;
}

Points catenary_shape(const CatenaryProperties& properties, const Vec3& acceleration, const Mat<3, 2>& x_ref,
                      const Vec<6>& u, int parts) {
  const Plane plane = plane_of(properties, acceleration, x_ref, u);
  const Vec3 start = x_ref.col(0) + u.head<3>(), end = x_ref.col(1) + u.tail<3>();
  Points points{start};
  if (is_loose(plane)) {
    for (int i = 1; i < parts; ++i) points.push_back(start + (end - start) * i / parts);
  } else {
    const Hanging cable = hang(plane);
    for (int i = 1; i < parts; ++i) points.push_back(start + place(cable, plane.length * i / parts));
  }
  points.push_back(end);
  return points;
}

}  // namespace tautline::element
