#pragma once
/// @file
/// The net while a frame yields under it: what it pulls with, and how that changes with its ends.

#include <vector>

#include <tautline/model/model.hpp>

namespace tautline::steps {

/// E A over the tension of a cable so stretched that it pulls in proportion to its length.
constexpr double force_density_kept = 1e-6;

/// @brief What the cables and cloth of the groups `found` pull their nodes with, present states and places
/// [N].
/// @throws ModelError for cloth of quadrilaterals
Points net_pull(const model::Model& structure, const std::vector<bool>& found);

/// A net of which every branch keeps its force density, so that its pull is linear in the places of its
/// nodes. Branches in compression have no part in it: they would pull it off its place.
struct FrozenNet {
  model::Group group;                ///< of the branches, to be the structure's last
  std::vector<model::Cable> cables;  ///< with their states at the present places
  Points pull;                       ///< of these cables on the nodes [N]
};

/// @param[in] yielding  by cable: E A over its tension, close to 0 for a force density that is kept;
/// infinite:
///                      as it is, none becomes stiffer than that
FrozenNet freeze(const model::Model& structure, const std::vector<bool>& found,
                 const std::vector<double>& yielding);

}  // namespace tautline::steps
