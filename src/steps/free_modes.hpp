#pragma once
/// @file
/// Vibrations of a structure that supports leave free to move. Theory: docs/theory/free_structures.md

#include <vector>

#include <tautline/la/eigen_solver.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Modes in order, without the rigid ones: those with a frequency, and those that meet no resistance.
struct FreeModes {
  la::EigenPairs elastic, mechanisms;
};

/// Rigid motions that supports let happen and that no stiffness resists.
struct RigidModes {
  std::vector<la::Vector> modes;  ///< orthonormal in the mass
  std::vector<la::Vector>
      massless;  ///< such as a straight beam's turning about itself, without polar inertia
};

/// From geometry, and tried on the stiffness: none that resists is among them.
RigidModes rigid_modes(assembly::System& system, const la::SymmetricMatrix& stiffness,
                       const la::SymmetricMatrix& mass);

/// @brief `count` elastic modes beside `rigid` ones that are known, and all mechanisms below them.
/// @throws ModelError if there are too many mechanisms or a motion without stiffness and mass
FreeModes solve_free(assembly::System& system, const la::SymmetricMatrix& stiffness,
                     const la::SymmetricMatrix& mass, const RigidModes& rigid, int count);

}  // namespace tautline::steps
