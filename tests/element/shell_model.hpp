#pragma once
// Structured meshes of shells and a sparse Newton solver: just enough to hold the shell against closed forms
// and published values.

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <tautline/element/shell.hpp>
#include <vector>

namespace tautline::element::testing_shell {

struct ShellState {
  Points u;
  std::vector<Mat3> rotation;
};

template <int N>
struct ShellModel {
  Points x;
  std::vector<std::array<int, N>> elements;
  ShellSection section;
  std::vector<int> supported;     ///< dofs 6 * node + (0..2 displacement, 3..5 rotation)
  Points normal;                  ///< unit normals at the nodes
  Mat3 prestress = Mat3::Zero();  ///< tensor of membrane resultants in global axes [N/m]
  double free_strain = 0;

  int n_nodes() const { return static_cast<int>(x.size()); }
  int n_dofs() const { return 6 * n_nodes(); }
  ShellState at_rest() const {
    return {Points(x.size(), Vec3::Zero()), std::vector<Mat3>(x.size(), Mat3::Identity())};
  }
  VecX load(int node, int direction, double value) const {
    return value * VecX::Unit(n_dofs(), 6 * node + direction);
  }
  /// Supports those of `directions` (0..5) of the nodes that `where` picks.
  void support(const std::function<bool(const Vec3&)>& where, const std::vector<int>& directions) {
    for (int i = 0; i < n_nodes(); ++i)
      if (where(x[i]))
        for (const int d : directions) supported.push_back(6 * i + d);
  }
};

inline bool near(double a, double b) {
  return std::abs(a - b) < 1e-6 * (1 + std::abs(b));
}

/// Symmetry about the plane normal to `axis` (0..2), for the nodes that `where` picks.
template <int N>
void mirror(ShellModel<N>& model, int axis, const std::function<bool(const Vec3&)>& where) {
  model.support(where, {axis, 3 + (axis + 1) % 3, 3 + (axis + 2) % 3});
}

template <int N>
Mat<3, N> corners(const ShellModel<N>& model, int element) {
  Mat<3, N> corner;
  for (int i = 0; i < N; ++i) corner.col(i) = model.x[model.elements[element][i]];
  return corner;
}

using Map = std::function<Vec3(double, double)>;

/// Normal of the mapped surface; central differences, wrong by some 1e-10.
inline Vec3 normal_of(const Map& map, double r, double s) {
  const double step = 1e-5;
  return (map(r + step, s) - map(r - step, s)).cross(map(r, s + step) - map(r, s - step)).normalized();
}

/// @brief Mesh of nr x ns quadrilaterals, or twice as many triangles, over the unit square mapped by `map`.
///
/// Node (i, j) has the number i + (nr + 1) j.
template <int N>
ShellModel<N> grid(int nr, int ns, const Map& map, const ShellSection& section) {
  ShellModel<N> model;
  model.section = section;
  for (int j = 0; j <= ns; ++j) {
    for (int i = 0; i <= nr; ++i) {
      model.x.push_back(map(double(i) / nr, double(j) / ns));
      model.normal.push_back(normal_of(map, double(i) / nr, double(j) / ns));
    }
  }
  for (int j = 0; j < ns; ++j) {
    for (int i = 0; i < nr; ++i) {
      const int a = i + (nr + 1) * j, b = a + 1, c = b + nr + 1, d = a + nr + 1;
      if constexpr (N == 4) {
        model.elements.push_back({a, b, c, d});
      } else {
        model.elements.push_back({a, b, c});
        model.elements.push_back({a, c, d});
      }
    }
  }
  return model;
}

template <int N>
ShellResponse<N> evaluate(const ShellModel<N>& model, const ShellState& state, int element,
                          Want want = Want::tangent) {
  ShellGeometry<N> geometry;
  ShellMotion<N> motion;
  geometry.x_ref = corners(model, element);
  const Mat3 frame = shell_frame<N>(geometry.x_ref);
  const Mat3 prestress = frame.transpose() * model.prestress * frame;
  geometry.prestress << prestress(0, 0), prestress(1, 1), prestress(0, 1);
  geometry.free_strain = model.free_strain;
  for (int i = 0; i < N; ++i) {
    const int node = model.elements[element][i];
    geometry.director.col(i) = model.normal[node];
    motion.u.col(i) = state.u[node];
    motion.rotation[i] = state.rotation[node];
  }
  return evaluate_shell<N>(model.section, geometry, motion, want);
}

/// Sum of the elements, supported dofs replaced by rows of the identity.
struct Assembled {
  double energy = 0;
  VecX force;
  Eigen::SparseMatrix<double> tangent;
};

template <int N>
std::vector<bool> fixed_dofs(const ShellModel<N>& model) {
  std::vector<bool> fixed(model.n_dofs(), false);
  for (const int dof : model.supported) fixed[dof] = true;
  return fixed;
}

template <int N>
Assembled assemble(const ShellModel<N>& model, const ShellState& state) {
  Assembled sum{0, VecX::Zero(model.n_dofs()), Eigen::SparseMatrix<double>(model.n_dofs(), model.n_dofs())};
  const std::vector<bool> fixed = fixed_dofs(model);
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) {
    const ShellResponse<N> response = evaluate(model, state, e);
    sum.energy += response.energy;
    const auto dof = [&](int k) { return 6 * model.elements[e][k / 6] + k % 6; };
    for (int i = 0; i < 6 * N; ++i) {
      sum.force[dof(i)] += response.force[i];
      for (int j = 0; j < 6 * N; ++j)
        if (dof(i) >= dof(j) && !fixed[dof(i)] && !fixed[dof(j)])
          entries.emplace_back(dof(i), dof(j), response.tangent(i, j));
    }
  }
  for (int i = 0; i < model.n_dofs(); ++i)
    if (fixed[i]) entries.emplace_back(i, i, 1);
  sum.tangent.setFromTriplets(entries.begin(), entries.end());
  return sum;
}

inline void move(ShellState& state, const VecX& step) {
  for (int i = 0; i < static_cast<int>(state.u.size()); ++i) {
    state.u[i] += step.segment<3>(6 * i);
    const Vec3 spin = step.segment<3>(6 * i + 3);
    const double angle = spin.norm();
    if (angle > 0) state.rotation[i] = Eigen::AngleAxisd(angle, spin / angle) * state.rotation[i];
  }
}

/// Solves with the tangent of one state; several right-hand sides.
template <int N>
class Solver {
 public:
  explicit Solver(const ShellModel<N>& model) : fixed_(fixed_dofs(model)) {}
  void factorise(const Eigen::SparseMatrix<double>& tangent) {
    if (!analysed_) factors_.analyzePattern(tangent);
    analysed_ = true;
    factors_.factorize(tangent);
    if (factors_.info() != Eigen::Success) throw std::runtime_error("singular tangent");
  }
  VecX free_part(VecX v) const {
    for (int i = 0; i < v.size(); ++i)
      if (fixed_[i]) v[i] = 0;
    return v;
  }
  VecX solve(const VecX& right_side) const { return factors_.solve(free_part(right_side)); }
  VecX pivots() const { return factors_.vectorD(); }

 private:
  std::vector<bool> fixed_;
  bool analysed_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

/// Norms of the Newton steps of one equilibrium.
using History = std::vector<double>;

/// Newton to equilibrium with `load`; forces and moments keep their directions.
template <int N>
History equilibrate(const ShellModel<N>& model, const VecX& load, ShellState& state, double tolerance = 1e-8,
                    int most = 60) {
  Solver<N> solver(model);
  History history;
  while (static_cast<int>(history.size()) < most) {
    const Assembled sum = assemble(model, state);
    solver.factorise(sum.tangent);
    const VecX step = solver.solve(load - sum.force);
    move(state, step);
    history.push_back(step.norm());
    if (history.back() < tolerance) return history;
    if (!(history.back() < 1e6)) break;
  }
  throw std::runtime_error("Newton did not converge");
}

/// Displacements of a linear analysis.
template <int N>
VecX linear_solution(const ShellModel<N>& model, const VecX& load) {
  Solver<N> solver(model);
  solver.factorise(assemble(model, model.at_rest()).tangent);
  return solver.solve(load);
}

/// Newton at a given displacement of one dof; returns the factor of the load that holds it there.
template <int N>
double equilibrate_at(const ShellModel<N>& model, const VecX& load, int dof, double displacement,
                      double& factor, ShellState& state, double tolerance = 1e-8) {
  Solver<N> solver(model);
  for (int iteration = 0; iteration < 40; ++iteration) {
    const Assembled sum = assemble(model, state);
    solver.factorise(sum.tangent);
    const VecX by_residual = solver.solve(factor * load - sum.force);
    const VecX by_load = solver.solve(load);
    const double missing = displacement - state.u[dof / 6][dof % 6];
    const double change = (missing - by_residual[dof]) / by_load[dof];
    const VecX step = by_residual + change * by_load;
    factor += change;
    move(state, step);
    if (step.norm() < tolerance) return factor;
  }
  throw std::runtime_error("Newton did not converge");
}

}  // namespace tautline::element::testing_shell
