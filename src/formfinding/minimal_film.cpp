#include <tautline/formfinding/minimal_film.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/film_sides.hpp>
#include <formfinding/net_forces.hpp>
#include <formfinding/position_search.hpp>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

/// The film as a net: the cables' branches, then every side of a triangle once.
class FilmNet {
 public:
  explicit FilmNet(const Film& film) : film_(film), sides_(find_sides(film.triangles)), net_(film.net) {
    net_.branches.insert(net_.branches.end(), sides_.nodes.begin(), sides_.nodes.end());
  }

  const Net& net() const noexcept { return net_; }

  /// Those of the cables and the natural ones of the film [N/m].
  VecX force_density(const NetState& state) const { return force_density(state, natural(state.nodes)); }
  /// The same with given ones of the film.
  VecX force_density(const NetState& state, const VecX& of_film) const {
    const auto n_cables = static_cast<Eigen::Index>(film_.net.branches.size());
    VecX q(static_cast<Eigen::Index>(net_.branches.size()));
    for (Eigen::Index i = 0; i < n_cables; ++i)
      q[i] = std::isnan(film_.cable_tension[i]) ? film_.cable_force_density[i]
                                                : film_.cable_tension[i] / state.length[i];
    q.tail(of_film.size()) = of_film;
    return q;
  }
  VecX natural(const Coordinates& nodes) const {
    return natural_force_density(sides_, film_.triangles, film_.surface_stress, nodes);
  }

 private:
  const Film& film_;
  FilmSides sides_;
  Net net_;
};

/// The film as an elastic net of constant tensions, which has the checks and the scale of the forces.
ElasticNet as_elastic(const Film& film) {
  ElasticNet net{film.net, {}, {}, film.cable_tension, film.triangles, film.surface_stress};
  for (Eigen::Index b = 0; b < net.tension.size(); ++b) {
    if (!std::isnan(net.tension[b])) continue;
    if (film.cable_force_density.size() != net.tension.size())
      throw ModelError(fmt::format("cable {} of the film has neither tension nor force density", b));
    const auto [i, j] = film.net.branches[b];
    net.tension[b] = film.cable_force_density[b] * (film.net.nodes[j] - film.net.nodes[i]).norm();
  }
  if (net.tension.size() != static_cast<Eigen::Index>(film.net.branches.size()))
    throw ModelError(
        fmt::format("the film has {} cables, but {} tensions", film.net.branches.size(), net.tension.size()));
  return net;
}

constexpr int n_shapes = 3, n_sweeps = 6;  // of the start
constexpr int patience = 100;              // iterations before another start, or edges that slide, are tried

/// @brief A start in which the nodes have followed the edges: nets of the film's force densities, moving in
/// all directions, while the cables come to their tensions.
///
/// On their own the nodes of the film move across it only, and edges that go further than a mesh would turn
/// triangles over. Where these nets have no shape, the drawn one is the start.
NetState find_start(NetSystem& system, const FilmNet& net, const NetState& drawn) {
  NetState state = drawn;
  try {
    for (int shape = 0; shape < n_shapes; ++shape) {
      const VecX of_film = net.natural(state.nodes);
      for (int sweep = 0; sweep < n_sweeps; ++sweep) {
        const VecX q = net.force_density(state, of_film);
        system.factorise(q);
        if (system.negative_pivots() > 0) return drawn;
        state = system.equilibrium(q);
      }
    }
  } catch (const ModelError&) {
    return drawn;
  }
  return state;
}

}  // namespace

FilmResult find_minimal_film(const Film& film, const MinimalFilmOptions& options,
                             const std::function<void(int, double)>& progress) {
  const ElasticNet elastic = as_elastic(film);
  check(elastic);
  ElasticNet as_drawn = elastic;
  as_drawn.tension = film.cable_tension;  // cables of given force density are no edges of constant tension
  const FilmNet net(film);
  const Coordinates start = to_coordinates(film.net.nodes);
  check_areas(film.triangles, start);
  NetSystem system(net.net());
  const double limit = options.tolerance * net_forces(elastic, start).scale;
  const auto search = [&](const NetState& from, bool edges_slide, int most) {
    return find_fixed_point(
        system, [&](const NetState& state) { return net.force_density(state); }, from, limit, most,
        [&](const NetState& state, Coordinates& force) {
          FilmDirections directions = film_directions(as_drawn, state.nodes);
          if (!edges_slide) directions.tangent.setZero();
          keep_what_counts(directions, system.free_nodes(), force);
        },
        progress);
  };
  const NetState drawn =
      system.state(VecX::Zero(static_cast<Eigen::Index>(net.net().branches.size())), start);
  const int some = std::min(options.max_iterations, patience);
  PositionResult found = search(drawn, false, some);
  if (!found.converged) {
    const NetState nearer = find_start(system, net, drawn);
    found = search(nearer, false, some);
    if (!found.converged) found = search(nearer, true, options.max_iterations);
  }
  FilmResult result;
  result.converged = found.converged;
  result.nodes = to_points(found.state.nodes);
  const auto n_cables = static_cast<Eigen::Index>(film.net.branches.size());
  result.cable_tension = net.force_density(found.state).cwiseProduct(found.state.length).head(n_cables);
  for (Eigen::Index b = 0; b < n_cables; ++b)
    if (!std::isnan(film.cable_tension[b])) result.cable_tension[b] = film.cable_tension[b];
  for (const auto& triangle : film.triangles) result.area += area(triangle, found.state.nodes);
  if (found.converged)
    result.side_force_density = balanced_sides(system, found.state, film.triangles, film.surface_stress);
  result.out_of_balance = found.residual.back();
  result.iterations = found.iterations;
  result.residual = found.residual;
  result.reason = found.reason(limit);
  return result;
}

}  // namespace tautline::formfinding
