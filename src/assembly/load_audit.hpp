#pragma once
/// @file
/// What loads are by their definitions, to compare with what is assembled of them. Theory:
/// docs/theory/loads.md#audit

#include <vector>

#include <tautline/assembly/dof_map.hpp>
#include <tautline/assembly/kinematics.hpp>
#include <tautline/assembly/system.hpp>
#include <tautline/model/model.hpp>

namespace tautline::assembly {

/// Sums of force, and of moment about the origin, with the sums of magnitudes that their rounding goes by.
struct LoadSum {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double force_size = 0, moment_size = 0;
  double heat = 0, heat_size = 0;  ///< change of temperature times length or area of the elements

  void add(const Vec3& at, const Vec3& force, const Vec3& moment = Vec3::Zero());
};

/// @brief Adds the resultant of a load on the structure as drawn, from what the deck says of it and the
/// geometry.
///
/// Shares no code with assembly. A load along a catenary counts in the middle of the chord.
/// @param[in] strains  initial strains of the cables, by which the weight of a drawn length goes
void add_definition(const model::Model& model, const std::vector<double>& strains, const model::Load& load,
                    LoadSum& sum);

/// @throws ModelError for imposed motions of what no support holds but something else leads
void check_motions(const model::Model& model, const Boundary& boundary, const DofMap& map,
                   const Kinematics& kinematics);

}  // namespace tautline::assembly
