#pragma once
/// @file
/// The part of a structure that form-finding works on, and the way back to the structure.

#include <memory>
#include <string>
#include <tautline/formfinding/film_facet.hpp>
#include <tautline/formfinding/net.hpp>
#include <tautline/formfinding/node_error.hpp>
#include <vector>

#include "steps/context.hpp"

namespace tautline::steps {

/// The net as stage 1 sees it. Branches are in the order of `groups` and within them of the structure.
struct FormNet {
  std::vector<std::string> groups;  ///< of cables
  std::vector<std::string> cloth;   ///< of membranes
  formfinding::Net net;
  std::vector<int> cables;                   ///< structure cable of each branch
  std::vector<int> nodes;                    ///< structure node of each net node
  std::vector<int> local;                    ///< net node of each structure node, or -1
  std::vector<int> membranes;                ///< structure membrane of each facet of the film
  std::vector<formfinding::FilmFacet> film;  ///< the cloth
  std::unique_ptr<formfinding::Surface> own_surface;
  const formfinding::Surface* surface = nullptr;  ///< the reflector's, or own_surface; or null
  VecX drawn_tension;      ///< of each branch, whatever becomes of the structure meanwhile [N]
  VecX drawn_length;       ///< of each branch [m]
  VecX unstressed_length;  ///< of each branch as drawn [m]
  VecX start_density;      ///< of a net found before, near which the next is looked for [N/m]; may be empty
  VecX force_density;      ///< of each branch, in place of the drawn one [N/m]; empty: as drawn

  double stiffness(const model::Model& structure, std::size_t branch) const;
  bool is_bar(const model::Model& structure, int branch) const;
  /// Branches of the named groups, in the order of the names. @throws ModelError for a group outside the net
  std::vector<int> branches_of(const model::Model& structure, const std::vector<std::string>& names) const;
  /// Net nodes of the named groups and selections. @throws ModelError for a node outside the net
  std::vector<int> nodes_of(const model::Model& structure, const std::vector<std::string>& names) const;
  /// "node "c" at (0, 0, 1)", or where it is drawn alone if the deck has no name for it.
  std::string node_name(const Context& context, int node) const;
  /// "cable 3 of ridge, from (0, 0, 1) to (1, 0, 1)"
  std::string describe(const model::Model& structure, int branch) const;
};

/// The error by the deck's names.
ModelError named(const Context& context, const FormNet& form, const formfinding::NetError& error);

/// @throws ModelError where the options do not fit the structure
FormNet extract_net(const Context& context, const FormFindingOptions& options);

}  // namespace tautline::steps
