#pragma once
// A system's tangent and residual as dense arrays, whole on every rank.

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <tautline/assembly/system.hpp>
#include <tautline/model/state.hpp>
#include <vector>

namespace tautline::assembly::testing_models {

/// Away from equilibrium and turned: every node by another rotation.
inline model::State some_state(const model::Model& model) {
  auto state = model::State::reference(model);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    const double k = static_cast<double>(i);
    state.displacement[i] = 0.05 * Vec3(std::sin(1 + 3 * k), std::cos(2 * k), std::sin(5 * k));
    if (model.rotational_nodes()[i])
      state.rotation[i] = Eigen::AngleAxisd(0.3 + 0.1 * k, Vec3(std::cos(k), std::sin(k), 0.5).normalized())
                              .toRotationMatrix();
  }
  return state;
}

/// Of what multiplies vectors of the system's unknowns.
template <class Operator>
MatX dense_of(const Operator& matrix, const System& system) {
  MatX dense(system.n_dofs(), system.n_dofs());
  const auto& layout = system.layout();
  for (int j = 0; j < system.n_dofs(); ++j) {
    std::vector<double> unit(static_cast<std::size_t>(system.n_dofs()), 0.0), column;
    unit[static_cast<std::size_t>(j)] = 1;
    la::Vector x(layout), y(layout);
    x.write(std::span(unit).subspan(3 * layout.first, 3 * layout.local));
    matrix.multiply(x, y);
    y.gather(column);
    dense.col(j) = Eigen::Map<const VecX>(column.data(), system.n_dofs());
  }
  return dense;
}

inline MatX dense_tangent(System& system) {
  auto k = system.new_matrix();
  system.tangent(k);
  return dense_of(k, system);
}

inline VecX residual_at(System& system, const VecX& increment) {
  const auto& layout = system.layout();
  la::Vector x(layout), f(layout);
  x.write(std::span(increment.data() + 3 * layout.first, static_cast<std::size_t>(3 * layout.local)));
  system.residual(x, f);
  std::vector<double> all;
  f.gather(all);
  return Eigen::Map<const VecX>(all.data(), system.n_dofs());
}

/// The derivative of the residual by differences: truncation h^4, rounding 1e-16/h of the stiffness.
inline MatX derivative_of_residual(System& system) {
  const int n = system.n_dofs();
  const double h = 1e-3;
  MatX result(n, n);
  for (int j = 0; j < n; ++j) {
    const auto at = [&](double step) { return residual_at(system, step * VecX::Unit(n, j)); };
    result.col(j) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  }
  return result;
}

/// The tangent of the present state is symmetric, and the symmetric part of the residual's derivative; held
/// unknowns have a stiffness of their own and nothing else.
inline void expect_tangent_is_derivative_of_residual(System& system) {
  const MatX tangent = dense_tangent(system);
  const MatX differences = derivative_of_residual(system);
  MatX symmetric = (differences + differences.transpose()) / 2;
  for (int i = 0; i < system.n_dofs(); ++i)
    if (system.held()[static_cast<std::size_t>(i)]) {
      symmetric.row(i).setZero();
      symmetric.col(i).setZero();
      symmetric(i, i) = tangent(i, i);
      EXPECT_GT(tangent(i, i), 0);
    }
  EXPECT_LT((tangent - symmetric).norm(), 1e-8 * tangent.norm());
  EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * tangent.norm());
}

/// What every unknown that is not held adds to a state, up to `size` metres and radians.
inline std::vector<double> some_increments(const System& system, double size) {
  std::vector<double> x(static_cast<std::size_t>(system.n_dofs()));
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] = system.held()[i] ? 0 : size * std::sin(1.7 * static_cast<double>(i) + 0.3);
  return x;
}

}  // namespace tautline::assembly::testing_models
