#pragma once
/// @file
/// Energy of the generalised strains of a shell element. Theory: docs/theory/shell.md#energy

#include <tautline/element/shell.hpp>

#include "shell_strains.hpp"

namespace tautline::element::detail {

/// W = prestress . e + e . stiffness e / 2 for the strains e of `ShellTable`; block-diagonal.
template <int N>
struct ShellStiffness {
  Mat<ShellTable<N>::n_membrane> membrane;
  Mat<ShellTable<N>::n_bending> bending;
  Mat<ShellTable<N>::n_shear> shear;
  double drilling = 0;  ///< for each node's drilling strain
  /// In-plane rotation of the mid-surface at the nodes less that at the centre, by membrane strains.
  Mat<N, ShellTable<N>::n_membrane> rotation_of_node;
  Vec<ShellTable<N>::n_membrane> prestress;
  /// Resultants at the centre, in the frame, by strains.
  Mat<3, ShellTable<N>::n_membrane> membrane_force;
  Mat<3, ShellTable<N>::n_bending> moment;
  Mat<2, ShellTable<N>::n_shear> shear_force;
};

/// @param[in] reference  modes of the reference configuration
/// @param[in] prestress  N11, N22, N12 in shell_frame [N/m]
template <int N>
ShellStiffness<N> shell_stiffness(const ShellSection& section, const ShellModes<N>& reference,
                                  const Vec3& prestress);

/// Area of the quadrilateral or triangle spanned by the position modes.
template <int N>
double area_of(const ShellModes<N>& reference);

/// Integrals of the products of shape functions over the reference area [m^2].
template <int N>
Mat<N> shape_products(const ShellModes<N>& reference);

}  // namespace tautline::element::detail
