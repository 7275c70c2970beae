#include <tautline/assembly/influence.hpp>

#include <algorithm>

#include <tautline/core/error.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/catenary.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>

#include "assembly/expansion.hpp"

namespace tautline::assembly {

namespace {

constexpr int block_of_columns = 64;  // right-hand sides solved at once

/// d force / d quantity of a catenary, by central differences.
Vec<6> catenary_rate(const model::Model& model, const model::Cable& cable, const Vec<6>& u,
                     CableQuantity quantity) {
  const auto x_ref = model::reference_nodes<2>(model, cable.nodes);
  const auto properties = model::catenary_properties(model, cable);
  const bool length = quantity == CableQuantity::unstressed_length;
  const double h = 1e-5 * (length ? properties.unstressed_length : properties.axial_stiffness);
  const auto force = [&](double change) {
    auto changed = properties;
    (length ? changed.unstressed_length : changed.axial_stiffness) += change;
    changed.line_load *= properties.unstressed_length / changed.unstressed_length;  // in all the same
    return Vec<6>(
        element::evaluate_catenary(changed, model.acceleration, x_ref, u, element::Want::force).force);
  };
  return (force(h) - force(-h)) / (2 * h);
}

/// d force / d quantity with the ends held.
Vec<6> force_rate(const System& system, const model::Cable& cable, CableQuantity quantity) {
  const auto& model = system.model();
  const auto u = model::displacements<2>(system.state(), cable.nodes);
  if (model.groups[cable.group].kind == model::ElementKind::catenary)
    return catenary_rate(model, cable, u, quantity);
  const auto [properties, x_ref] = model::cable_data(model, cable);
  if (quantity == CableQuantity::unstressed_length) {
    const Vec3 weight = model.groups[cable.group].cable.mass_per_length * model.acceleration;  // of a metre
    Vec<6> rate = element::cable_force_by_unstressed_length(properties, x_ref, u);
    rate.head<3>() -= weight / 2;
    rate.tail<3>() -= weight / 2;
    return rate;
  }
  return element::evaluate_cable(properties, x_ref, u, element::Want::force).force /
         properties.axial_stiffness;  // the force is proportional to E A
}

/// This rank's rows of -df/dp for parameters[begin, end).
MatX right_hand_sides(const System& system, const std::vector<CableParameter>& parameters, int begin,
                      int end) {
  const auto& layout = system.layout();
  MatX b = MatX::Zero(3 * layout.local, end - begin);
  std::vector<double> all(static_cast<std::size_t>(system.n_dofs()), 0.0);
  for (int k = begin; k < end; ++k) {
    for (const auto& [index, rate] : parameters[k].parts) {
      const auto& cable = system.model().cables[index];
      const Vec<6> derivative = rate * force_rate(system, cable, parameters[k].quantity);
      Expansion(system.kinematics(), system.dof_map(), cable.nodes, false).add(derivative, all);
      for (const int block : unknowns_of(system.model(), system.dof_map(), cable))
        for (int c = 0; c < 3; ++c) {
          const int unknown = 3 * block + c, row = unknown - 3 * layout.first;
          double& value = all[static_cast<std::size_t>(unknown)];
          if (row >= 0 && row < b.rows() && !system.held()[unknown]) b(row, k - begin) -= value;
          value = 0;
        }
    }
  }
  return b;
}

}  // namespace

MatX influence(System& system, analysis::Workspace& workspace, const std::vector<CableParameter>& parameters,
               const std::vector<int>& nodes) {
  system.tangent(workspace.tangent);
  if (!workspace.solver.factor(workspace.tangent)) throw LibraryError(workspace.solver.failure());
  const auto& layout = system.layout();
  const int n = static_cast<int>(parameters.size());
  std::vector<double> all(3 * nodes.size() * parameters.size(), 0.0);
  Eigen::Map<MatX> result(all.data(), static_cast<Eigen::Index>(3 * nodes.size()), n);
  for (int begin = 0; begin < n; begin += block_of_columns) {
    const int end = std::min(n, begin + block_of_columns);
    const MatX x = workspace.solver.solve_many(right_hand_sides(system, parameters, begin, end));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const auto& [block, matrix] : system.kinematics().displacement(nodes[i]))
        if (system.dof_map().owns(block))
          result.block(static_cast<Eigen::Index>(3 * i), begin, 3, end - begin) +=
              matrix * x.middleRows(3 * (block - layout.first), 3);
  }
  la::sum_over_ranks(all);
  return result;
}

MatX length_influence(System& system, analysis::Workspace& workspace, const std::vector<int>& cables,
                      const std::vector<int>& nodes) {
  std::vector<CableParameter> parameters;
  for (const int cable : cables) parameters.push_back({CableQuantity::unstressed_length, {{cable, 1.0}}});
  return influence(system, workspace, parameters, nodes);
}

}  // namespace tautline::assembly
