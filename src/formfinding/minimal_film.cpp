#include <tautline/formfinding/minimal_film.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/film_balance.hpp>
#include <formfinding/film_mesh.hpp>
#include <formfinding/net_forces.hpp>
#include <formfinding/position_search.hpp>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

/// The film as a net of constant tensions and force densities.
ElasticNet as_elastic(const Film& film) {
  ElasticNet net{film.net, {}, {}, film.cable_tension, film.facets};
  const auto n = static_cast<Eigen::Index>(film.net.branches.size());
  if (film.cable_tension.size() != n)
    throw ModelError(fmt::format("the film has {} cables, but {} tensions", n, film.cable_tension.size()));
  net.force_density = film.cable_force_density;
  for (Eigen::Index b = 0; b < n; ++b)
    if (std::isnan(film.cable_tension[b]) && film.cable_force_density.size() != n)
      throw ModelError(fmt::format("cable {} of the film has neither tension nor force density", b + 1));
  return net;
}

constexpr int n_sweeps = 6;  // of the start

/// @brief A start in which the nodes have followed the edges: the net of the drawn film's force densities,
/// moving in all directions, while the cables come to their tensions.
///
/// Where this net has no shape, the drawn one is the start.
NetState find_start(NetSystem& system, const FilmNet& net, const NetState& drawn) {
  NetState state = drawn;
  try {
    for (int sweep = 0; sweep < n_sweeps; ++sweep) {
      VecX q = net.force_density(state.nodes);
      q.tail(q.size() - net.n_cables()) = net.drawn.tail(q.size() - net.n_cables());
      system.factorise(q);
      if (system.negative_pivots() > 0) return drawn;
      state = system.equilibrium(q);
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
  check_areas(film.net, film.facets);
  const FilmNet net(elastic);
  const Coordinates start = to_coordinates(film.net.nodes);
  NetSystem system(net.net), mesh_system(net.net);
  const double limit = options.tolerance * net_forces(elastic, start).scale;
  mesh_system.factorise(net.drawn);
  const PlaceRule rule{
      [&](const NetState& state, Coordinates& force) {
        FilmMesh(net, system.free_nodes(), state.nodes).take_drawn_forces(state.nodes, force);
      },
      [&](const NetState& state, const Coordinates& force, Coordinates& step) {
        FilmMesh(net, system.free_nodes(), state.nodes).take(mesh_system.respond(state, force), step);
      }};
  const auto search = [&](const NetState& from) {
    return find_fixed_point(
        system, [&](const NetState& state) { return net.force_density(state.nodes); }, from, limit,
        options.max_iterations, rule, progress);
  };
  const NetState drawn = system.state(net.drawn, start);
  PositionResult found = search(find_start(system, net, drawn));
  if (!found.converged) found = search(drawn);

  FilmResult result;
  result.converged = found.converged;
  result.nodes = to_points(found.state.nodes);
  result.cable_tension = net_forces(elastic, found.state.nodes).tension;
  result.stress = target_stresses(film.facets, found.state.nodes);
  result.out_of_balance = found.residual.back();
  result.iterations = found.iterations;
  result.residual = found.residual;
  result.reason = found.reason(limit);
  if (!found.converged) result.reason += held_points(film.net, film.facets);
  if (found.converged) {
    const SettledFilm settled = settle_film(elastic, result.nodes, options.tolerance);
    result.nodes = settled.nodes;
    result.stress = settled.stress;
    result.cable_tension = settled.tension;
    result.out_of_balance = settled.out_of_balance;
    result.converged = settled.fault.empty();
    if (!result.converged) result.reason = settled.fault;
  }
  for (const auto& facet : film.facets) result.area += area(facet, to_coordinates(result.nodes));
  return result;
}

}  // namespace tautline::formfinding
