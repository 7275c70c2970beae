#include <formfinding/film_balance.hpp>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <formfinding/elastic_tangent.hpp>
#include <formfinding/film_element.hpp>
#include <formfinding/net_forces.hpp>
#include <tautline/material/plane_stress.hpp>

namespace tautline::formfinding {

namespace {

constexpr double elasticity = 1;  // E h of the film over its mean stress
constexpr int max_steps = 30;     // of Newton's method
constexpr int max_rounds = 4;     // after each the stress of the moved film is that of a new reference
constexpr int max_halvings = 6;
constexpr double closer = 1e-3;     // than the step's tolerance, which one step of Newton's method gives
constexpr double rounding = 1e-12;  // of forces, over the largest
constexpr double first_shift = 1e-3, largest_shift = 1e3;  // of the stiffness at each node

/// Tangents of the facet's surface at its middle, in its frame; columns.
template <int N>
Mat<2> tangents(const Mat<3, N>& x) {
  Mat<3, 2> g;
  if constexpr (N == 3)
    g << x.col(1) - x.col(0), x.col(2) - x.col(0);
  else
    g << x.col(1) + x.col(2) - x.col(0) - x.col(3), x.col(2) + x.col(3) - x.col(0) - x.col(1);
  return element::membrane_frame<N>(x).template leftCols<2>().transpose() * g;
}

class FilmBalance {
 public:
  FilmBalance(const ElasticNet& net, const Coordinates& nodes)
      : net_(net),
        system_(net.net),
        tangent_(net),
        reference_(nodes),
        nodes_(nodes),
        stress_(target_stresses(net.film, nodes)) {
    without_film_.film.clear();
    evaluate();
  }

  double largest() const { return force_.rows() > 0 ? force_.rowwise().norm().maxCoeff() : 0.0; }
  double scale() const { return scale_; }
  /// Newton's method on the film of this reference.
  void find_rest(double limit);
  /// The film where it has gone to, with the stress it has there, as the reference.
  void refer_anew();
  SettledFilm result() const { return {to_points(nodes_), stress_, tension_, largest(), {}}; }

 private:
  element::MembraneLaw law(std::size_t facet) const {
    const auto& s = net_.film[facet].stress;
    return {material::plane_stress_stiffness(elasticity * (s[0] + s[1]) / 2, 0.0), stress_[facet]};
  }
  template <int N>
  element::MembraneResponse<N> respond(std::size_t facet, const Mat<3, N>& x_ref, element::Want want) const {
    Vec<3 * N> u;
    for (int k = 0; k < N; ++k)
      u.template segment<3>(3 * k) = nodes_.row(net_.film[facet].nodes[k]).transpose() - x_ref.col(k);
    return element::evaluate_membrane<N>(law(facet), x_ref, u, want);
  }
  /// `visit` with each facet and its reference corners.
  template <class Visit>
  void for_each_facet(const Visit& visit) const {
    for (std::size_t f = 0; f < net_.film.size(); ++f)
      with_corners(net_.film[f], reference_, [&](const auto& x_ref) { visit(f, x_ref); });
  }
  void evaluate();
  void add_film(const ElasticTangent::AddBlock& add) const;
  bool take_step();
  bool move(const Coordinates& dx);

  const ElasticNet& net_;
  ElasticNet without_film_ = net_;
  NetSystem system_;
  ElasticTangent tangent_;
  Coordinates reference_, nodes_;
  Points stress_;      ///< second Piola-Kirchhoff resultants in the reference [N/m]
  Coordinates force_;  ///< on the free nodes [N]
  VecX tension_;
  double scale_ = 0;
};

void FilmBalance::evaluate() {
  NetForces forces = net_forces(without_film_, nodes_);
  for_each_facet([&](std::size_t f, const auto& x_ref) {
    constexpr int n = std::decay_t<decltype(x_ref)>::ColsAtCompileTime;
    const auto pull = respond<n>(f, x_ref, element::Want::force).force;
    for (int k = 0; k < n; ++k)
      forces.force.row(net_.film[f].nodes[k]) -= pull.template segment<3>(3 * k).transpose();
    forces.scale =
        std::max(forces.scale, net_.film[f].largest_stress() * (x_ref.col(1) - x_ref.col(0)).norm());
  });
  force_ = system_.unbalanced(forces.force(system_.free_nodes(), Eigen::all));
  tension_ = std::move(forces.tension);
  scale_ = forces.scale;
}

void FilmBalance::add_film(const ElasticTangent::AddBlock& add) const {
  for_each_facet([&](std::size_t f, const auto& x_ref) {
    constexpr int n = std::decay_t<decltype(x_ref)>::ColsAtCompileTime;
    const auto tangent = respond<n>(f, x_ref, element::Want::tangent).tangent;
    const auto& nodes = net_.film[f].nodes;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        if (nodes[a] >= nodes[b]) add(nodes[a], nodes[b], tangent.template block<3, 3>(3 * a, 3 * b));
  });
}

bool FilmBalance::move(const Coordinates& dx) {
  const Coordinates start = nodes_;
  const double before = force_.norm();
  for (int i = 0; i <= max_halvings; ++i) {
    for (int k = 0; k < system_.n_free(); ++k)
      nodes_.row(system_.free_nodes()[k]) =
          start.row(system_.free_nodes()[k]) + std::ldexp(1.0, -i) * dx.row(k);
    evaluate();
    if (force_.norm() < before) return true;
  }
  nodes_ = start;
  evaluate();
  return false;
}

bool FilmBalance::take_step() {
  for (double shift = 0; shift <= largest_shift; shift = shift == 0 ? first_shift : 10 * shift)
    if (tangent_.factorise(nodes_, shift, [&](const auto& add) { add_film(add); }))
      if (move(system_.unbalanced(tangent_.solve(force_)))) return true;
  return false;
}

void FilmBalance::find_rest(double limit) {
  for (int step = 0; step < max_steps && largest() > limit; ++step)
    if (!take_step()) return;
}

void FilmBalance::refer_anew() {
  Points moved;
  for_each_facet([&](std::size_t f, const auto& x_ref) {
    constexpr int n = std::decay_t<decltype(x_ref)>::ColsAtCompileTime;
    const Vec3 pk2 = respond<n>(f, x_ref, element::Want::force).pk2_resultant;
    const Mat<2> F = tangents<n>(corners<n>(net_.film[f], nodes_)) * tangents<n>(x_ref).inverse();
    const Mat<2> S = (Mat<2>() << pk2[0], pk2[2], pk2[2], pk2[1]).finished();
    const Mat<2> cauchy = F * S * F.transpose() / F.determinant();
    moved.emplace_back(cauchy(0, 0), cauchy(1, 1), cauchy(0, 1));
  });
  stress_ = std::move(moved);
  reference_ = nodes_;
  evaluate();
}

}  // namespace

SettledFilm settle_film(const ElasticNet& net, const Points& nodes, double tolerance) {
  FilmBalance balance(net, to_coordinates(nodes));
  for (int round = 0; round < max_rounds; ++round) {
    const double limit = std::max(closer * tolerance, rounding) * balance.scale();
    if (round > 0 && balance.largest() <= limit) break;
    balance.find_rest(limit);
    balance.refer_anew();  // quadrilaterals are given the mean of their points
  }
  SettledFilm settled = balance.result();
  settled.fault = turned_over(net.net, net.film, to_coordinates(settled.nodes));
  if (!settled.fault.empty()) settled.fault += held_points(net.net, net.film);
  return settled;
}

}  // namespace tautline::formfinding
