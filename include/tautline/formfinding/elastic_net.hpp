#pragma once
/// @file
/// A net of elastic cables with unstressed lengths, cables of constant tension, and films of given stress;
/// its equilibrium by Newton's method (the stiffness-matrix method, Belov 2021, eqs 1.5-1.9).

#include <string>
#include <tautline/formfinding/elastic_net_options.hpp>
#include <tautline/formfinding/film_facet.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// Each branch is either elastic, T = EA (L / L0 - 1), a cable slack where that is negative, or has a
/// tension, or a force density.
struct ElasticNet {
  Net net;                                     ///< its nodes are the start
  VecX axial_stiffness;                        ///< EA of every branch [N]
  VecX unstressed_length;                      ///< L0 of every branch [m]
  VecX tension = {};                           ///< constant tension [N]; NaN: elastic; empty: all elastic
  std::vector<FilmFacet> film = {};            ///< facets of given stress
  std::vector<bool> carries_compression = {};  ///< branches that are bars; empty: none
  VecX force_density =
      {};  ///< constant, of branches that are not elastic and have no tension [N/m]; empty: none
};

struct ElasticResult {
  bool converged = false;
  std::string reason;         ///< one sentence with both sides of the inequality
  Points nodes;               ///< [m]
  VecX tension;               ///< [N]; slack: 0
  double out_of_balance = 0;  ///< largest force at a free node [N]
  int n_slack = 0;            ///< elastic branches without tension
  int iterations = 0;
  std::vector<double>
      residual;  ///< largest force out of balance before the first and after each iteration [N]
};

/// @brief Equilibrium of the net by Newton's method with a sparse tangent; a net with films needs
/// find_minimal_film or relax.
///
/// Where the tangent is not positive definite (slack cables, a start without tension) it is shifted, so that
/// every step leads to less energy.
/// @throws ModelError if the net makes no sense, or has films, guides or a surface
ElasticResult find_elastic_equilibrium(const ElasticNet& net, const ElasticOptions& options = {});

}  // namespace tautline::formfinding
