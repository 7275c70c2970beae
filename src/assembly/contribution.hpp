#pragma once
/// @file
/// What one element of any kind adds: force and tangent, mass. Rows go node by node, displacement first, then
/// the rotation where the element uses rotations.

#include <tautline/assembly/dof_map.hpp>
#include <tautline/assembly/system.hpp>
#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::assembly {

/// At most four nodes with six unknowns.
using ElementVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 24, 1>;
using ElementMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 24, 24>;

struct Contribution {
  ElementVector force;
  ElementMatrix tangent;  ///< only if wanted
};

Contribution contribution(const model::Model&, const model::State&, const model::Cable&, element::Want);
/// A cable, or a catenary without weight, on a branch of its law.
Contribution contribution(const model::Model&, const model::State&, const model::Cable&, Branch,
                          element::Want);
Contribution contribution(const model::Model&, const model::State&, const model::Beam&, element::Want);
Contribution contribution(const model::Model&, const model::State&, const model::Membrane&, element::Want);
Contribution contribution(const model::Model&, const model::State&, const model::Shell&, element::Want);
Contribution contribution(const model::Model&, const model::State&, const model::Spring&, element::Want);
Contribution contribution(const model::Model&, const model::State&, const model::MassElement&, element::Want);

/// Force and tangent with stresses foretold from those at `before` and the motion of the element's nodes
/// since.
Contribution extrapolated(const model::Model&, const model::State& before, const ElementVector& motion,
                          const model::State&, const model::Cable&);
Contribution extrapolated(const model::Model&, const model::State& before, const ElementVector& motion,
                          const model::State&, const model::Beam&);
Contribution extrapolated(const model::Model&, const model::State& before, const ElementVector& motion,
                          const model::State&, const model::Membrane&);
Contribution extrapolated(const model::Model&, const model::State& before, const ElementVector& motion,
                          const model::State&, const model::Shell&);

/// Follower pressure on a facet: forces on its nodes and their derivative.
Contribution pressure_contribution(const model::Model&, const model::State&, const model::FacetNodes&,
                                   double pressure, element::Want);

/// Mass matrices. Catenaries carry their weight themselves; the others' weight is mass times acceleration.
ElementMatrix mass_of(const model::Model&, const model::State&, const model::Cable&, MassKind);
ElementMatrix mass_of(const model::Model&, const model::State&, const model::Beam&, MassKind);
ElementMatrix mass_of(const model::Model&, const model::State&, const model::Membrane&, MassKind);
ElementMatrix mass_of(const model::Model&, const model::State&, const model::Shell&, MassKind);
ElementMatrix mass_of(const model::Model&, const model::State&, const model::Spring&, MassKind);
ElementMatrix mass_of(const model::Model&, const model::State&, const model::MassElement&, MassKind);

/// v^T K v of one element for a motion v of its nodes, from relative motions where that keeps digits [J].
template <class Element>
double second_variation(const model::Model& model, const model::State& state, const Element& element,
                        const ElementVector& v) {
  const auto c = contribution(model, state, element, element::Want::tangent);
  return v.dot(c.tangent * v);
}
double second_variation(const model::Model&, const model::State&, const model::Cable&, const ElementVector&);
double second_variation(const model::Model&, const model::State&, const model::Beam&, const ElementVector&);

}  // namespace tautline::assembly
