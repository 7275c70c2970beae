#include "detail/catenary_integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tautline::element::detail {

namespace {

/// Positive points of Gauss' rule of ten on [-1, 1], and their weights.
constexpr std::array<double, 5> gauss_point{0.1488743389816312, 0.4333953941292472, 0.6794095682990244,
                                            0.8650633666889845, 0.9739065285171717};
constexpr std::array<double, 5> gauss_weight{0.2955242247147529, 0.2692667193099963, 0.2190863625159821,
                                             0.1494513491505806, 0.0666713443086881};

/// Tension above half of this many weights of the piece is far from the branch points of 1/T, see
/// docs/theory/catenary.md#integrals.
constexpr double taut_ratio = 4;

/// Adds ds times the integrands at sigma, where the tension vector is `t`.
void add_point(const Vec<2>& t, double sigma, double ds, CatenaryIntegrals& sum) {
  const double T = t.norm();
  const double above = t[0] > 0 ? t[1] * t[1] / (T + t[0]) : T - t[0];  // T - t_n
  const double by_T = ds / T;
  sum.inverse += by_T;
  sum.inverse_moment += by_T * sigma;
  sum.excess += ds * above;
  sum.deficit += by_T * Vec<2>(above, -t[1]);
  const Vec<2> across(t[1], -t[0]);
  sum.flexibility += by_T / (T * T) * across * across.transpose();
}

/// By quadrature: the integrands are smooth and free of cancellation.
CatenaryIntegrals taut(const PlaneWeight& weight, const Vec<2>& force, double length) {
  CatenaryIntegrals sum{0, 0, 0, Vec<2>::Zero(), Mat<2>::Zero()};
  for (std::size_t i = 0; i < gauss_point.size(); ++i)
    for (const double sigma : {-gauss_point[i] * length / 2, gauss_point[i] * length / 2})
      add_point(force - sigma * weight.part, sigma, gauss_weight[i] * length / 2, sum);
  return sum;
}

/// T - tau with T^2 = H2 + tau^2.
double above(double T, double tau, double H2) {
  return tau > 0 ? H2 / (T + tau) : T - tau;
}

/// By closed forms in the axes (e, g): g along the weight, e across, towards the chord.
CatenaryIntegrals heavy(const PlaneWeight& weight, const Vec<2>& force, double length) {
  const Vec<2> n(weight.part[1] / weight.size, weight.part[0] / weight.size);  // the chord in (e, g)
  Mat<2> to_chord;                                                             // from (e, g) to (n, p)
  to_chord << n[0], n[1], -n[1], n[0];
  const double half = weight.size * length / 2;
  const Vec<2> in_eg = to_chord.transpose() * force;
  // Where the cable hangs in a plumb line, 1/T has a pole at H = 0; an H below rounding leaves a large
  // logarithm.
  const double H = std::abs(in_eg[0]) > 1e-20 * half ? in_eg[0] : 1e-20 * half;
  const double P = in_eg[1];
  const double H2 = H * H;
  const double tau1 = P + half, tau2 = P - half;
  const double T1 = std::sqrt(H2 + tau1 * tau1), T2 = std::sqrt(H2 + tau2 * tau2);
  const double S = T1 + T2;
  const double below_S = above(T1, tau1, H2) + above(T2, tau2, H2);    // S - 2 P
  const double above_S = above(T1, -tau1, H2) + above(T2, -tau2, H2);  // S + 2 P

  CatenaryIntegrals sum;
  // asinh(tau1/H) - asinh(tau2/H) = log((S + 2 half)/(S - 2 half))
  const double angle = std::log1p(4 * half / (above(T1, tau1, H2) + above(T2, -tau2, H2)));
  sum.inverse = angle / weight.size;
  sum.inverse_moment = P * (sum.inverse - 2 * length / S) / weight.size;
  const Vec<2> direction(H * sum.inverse, 2 * length * P / S);  // of t/T along e and g
  const double tension = length / 4 * (S + 4 * P * P / S) + H2 * sum.inverse / 2;
  sum.excess = tension - length * force[0];
  const double cos = std::abs(n[1]);
  const double along = cos * (n[1] > 0 ? below_S : above_S) / S;
  sum.deficit[0] = length * (n[0] * n[0] / (1 + cos) + along) - n[0] * direction[0];
  sum.deficit[1] = n[1] * direction[0] - n[0] * direction[1];
  const double gg = length / 2 * below_S * above_S / (S * T1 * T2);
  const double eg = -2 * H * P * length / (S * T1 * T2);
  Mat<2> flexibility;
  flexibility << sum.inverse - gg, eg, eg, gg;
  sum.flexibility = to_chord * flexibility * to_chord.transpose();
  return sum;
}

}  // namespace

CatenaryIntegrals catenary_integrals(const PlaneWeight& weight, const Vec<2>& force, double length) {
  const bool is_taut = force.norm() >= taut_ratio * weight.size * length / 2;
  return is_taut ? taut(weight, force, length) : heavy(weight, force, length);
}

}  // namespace tautline::element::detail
