#pragma once
/// @file
/// What a shell element feels: its generalised strains as a table of scalar products. Theory:
/// docs/theory/shell.md#strains

#include <array>

#include <tautline/core/types.hpp>

namespace tautline::element::detail {

/// Adds `factor` v_m . v_n to the strain number `strain`.
struct StrainTerm {
  int strain, m, n;
  double factor;
};

/// @brief Modes of an element and the strains made of them.
///
/// The modes v are the tangents of the mid-surface and the director field, linear in the nodes' positions and
/// directors; position modes come first. Strains come in the order membrane, bending, transverse shear.
template <int N>
struct ShellTable;

/// Quadrilateral with x = x_0 + r x_r + s x_s + rs x_d, directors likewise.
template <>
struct ShellTable<4> {
  static constexpr int n_position_modes = 3;
  static constexpr int n_modes = 7;
  static constexpr int n_membrane = 5, n_bending = 6, n_shear = 4;

  enum Mode { yr, ys, yd, d0, dr, ds, dd };
  enum Strain { m_rr, m_ss, m_rs, m_rd, m_sd, k_rr, k_ss, k_rs, k_rd, k_sd, k_dd, g_r, g_rs, g_s, g_sr };

  /// Weight of node i in mode m.
  static constexpr std::array<std::array<double, 4>, n_modes> weight{{{-.25, .25, .25, -.25},
                                                                      {-.25, -.25, .25, .25},
                                                                      {.25, -.25, .25, -.25},
                                                                      {.25, .25, .25, .25},
                                                                      {-.25, .25, .25, -.25},
                                                                      {-.25, -.25, .25, .25},
                                                                      {.25, -.25, .25, -.25}}};
  static constexpr std::array terms{
      // means and half differences of the Green-Lagrange strains of opposite edges, shear at the centre
      StrainTerm{m_rr, yr, yr, .5}, StrainTerm{m_rr, yd, yd, .5}, StrainTerm{m_ss, ys, ys, .5},
      StrainTerm{m_ss, yd, yd, .5}, StrainTerm{m_rs, yr, ys, 1}, StrainTerm{m_rd, yr, yd, 1},
      StrainTerm{m_sd, ys, yd, 1},
      // coefficients of the polynomials in r, s that the products of tangents and director derivatives are
      StrainTerm{k_rr, yr, dr, 1}, StrainTerm{k_ss, ys, ds, 1}, StrainTerm{k_rs, yr, ds, 1},
      StrainTerm{k_rs, ys, dr, 1}, StrainTerm{k_rd, yr, dd, 1}, StrainTerm{k_rd, yd, dr, 1},
      StrainTerm{k_sd, ys, dd, 1}, StrainTerm{k_sd, yd, ds, 1}, StrainTerm{k_dd, yd, dd, 1},
      // means and half differences of the shears in the middles of opposite edges
      StrainTerm{g_r, yr, d0, 1}, StrainTerm{g_r, yd, ds, 1}, StrainTerm{g_rs, yr, ds, 1},
      StrainTerm{g_rs, yd, d0, 1}, StrainTerm{g_s, ys, d0, 1}, StrainTerm{g_s, yd, dr, 1},
      StrainTerm{g_sr, ys, dr, 1}, StrainTerm{g_sr, yd, d0, 1}};
};

/// Triangle with x = x_1 + r x_r + s x_s; d0 is the director at the centroid.
template <>
struct ShellTable<3> {
  static constexpr int n_position_modes = 2;
  static constexpr int n_modes = 5;
  static constexpr int n_membrane = 3, n_bending = 3, n_shear = 3;

  enum Mode { yr, ys, d0, dr, ds };
  enum Strain { m_rr, m_ss, m_rs, k_rr, k_ss, k_rs, g_r, g_s, g_curl };

  static constexpr std::array<std::array<double, 3>, n_modes> weight{
      {{-1, 1, 0}, {-1, 0, 1}, {1. / 3, 1. / 3, 1. / 3}, {-1, 1, 0}, {-1, 0, 1}}};
  static constexpr std::array terms{
      StrainTerm{m_rr, yr, yr, .5}, StrainTerm{m_ss, ys, ys, .5}, StrainTerm{m_rs, yr, ys, 1},
      StrainTerm{k_rr, yr, dr, 1}, StrainTerm{k_ss, ys, ds, 1}, StrainTerm{k_rs, yr, ds, 1},
      StrainTerm{k_rs, ys, dr, 1},
      // shear at the centroid, and circulation, of the field that has the mean tangential shears of the edges
      StrainTerm{g_r, yr, d0, 1}, StrainTerm{g_r, yr, dr, 1. / 6}, StrainTerm{g_r, yr, ds, -1. / 6},
      StrainTerm{g_r, ys, dr, -1. / 6}, StrainTerm{g_s, ys, d0, 1}, StrainTerm{g_s, ys, ds, 1. / 6},
      StrainTerm{g_s, ys, dr, -1. / 6}, StrainTerm{g_s, yr, ds, -1. / 6}, StrainTerm{g_curl, yr, ds, .5},
      StrainTerm{g_curl, ys, dr, -.5}};
};

template <int N>
inline constexpr int n_shell_strains =
    ShellTable<N>::n_membrane + ShellTable<N>::n_bending + ShellTable<N>::n_shear;

template <int N>
using ShellModes = Mat<3, ShellTable<N>::n_modes>;

/// Modes of nodal positions (or displacements) and directors (or their increments).
template <int N>
ShellModes<N> shell_modes(const Mat<3, N>& positions, const Mat<3, N>& directors) {
  using Table = ShellTable<N>;
  ShellModes<N> modes;
  for (int m = 0; m < Table::n_modes; ++m) {
    const Mat<3, N>& nodes = m < Table::n_position_modes ? positions : directors;
    modes.col(m).setZero();
    for (int i = 0; i < N; ++i) modes.col(m) += Table::weight[m][i] * nodes.col(i);
  }
  return modes;
}

/// Strains between the modes `from` and `from + change`; their error is relative to the change.
template <int N>
Vec<n_shell_strains<N>> shell_strains(const ShellModes<N>& from, const ShellModes<N>& change) {
  Vec<n_shell_strains<N>> strains = Vec<n_shell_strains<N>>::Zero();
  for (const auto [k, m, n, factor] : ShellTable<N>::terms)
    strains[k] += factor * (from.col(m).dot(change.col(n)) + change.col(m).dot(from.col(n)) +
                            change.col(m).dot(change.col(n)));
  return strains;
}

}  // namespace tautline::element::detail
