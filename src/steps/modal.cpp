#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/la/eigen_solver.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/response.hpp>

#include "steps/context.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/summaries.hpp"
#include "steps/fields.hpp"

namespace tautline::steps {

namespace {

/// Unit rigid motions about the origin in the current positions: three translations, three rotations.
std::vector<la::Vector> rigid_motions(const assembly::System& system) {
  const auto& map = system.dof_map();
  const auto positions = model::positions(system.model(), system.state());
  std::vector<la::Vector> motions;
  for (int k = 0; k < 6; ++k) {
    std::vector<double> values(static_cast<std::size_t>(system.n_dofs()), 0.0);
    const Vec3 axis = Vec3::Unit(k % 3);
    for (std::size_t node = 0; node < positions.size(); ++node) {
      const Vec3 motion = k < 3 ? axis : Vec3(axis.cross(positions[node]));
      const auto set = [&](int block, const Vec3& value) {
        if (block >= 0)
          Eigen::Map<Vec3>(values.data() + 3 * block) = system.kinematics().unknown_of(block, value);
      };
      set(map.displacement_block[node], motion);
      const int link = system.kinematics().link_of(static_cast<int>(node));
      const bool hinge = link >= 0 && !system.model().links[link].hinge.empty();
      if (k >= 3 && !hinge) set(map.rotation_block[node], axis);
    }
    la::Vector vector(map.layout);
    vector.write(std::span(values).subspan(3 * map.layout.first, 3 * map.layout.local));
    motions.push_back(std::move(vector));
  }
  return motions;
}

/// (r^T M phi)^2 for modes normalised to phi^T M phi = 1: the mass that takes part [kg], [kg m^2]. What
/// symmetry makes zero comes out as rounding; below 1e-5 of the whole it is reported as zero.
Json effective_masses(const assembly::System& system, const la::SymmetricMatrix& mass,
                      const la::EigenPairs& pairs) {
  const auto motions = rigid_motions(system);
  Json table = Json::array();
  la::Vector product(system.layout());
  std::vector<double> whole;
  for (const auto& motion : motions) {
    mass.multiply(motion, product);
    whole.push_back(motion.dot(product));
  }
  for (const auto& mode : pairs.vectors) {
    mass.multiply(mode, product);
    Json row = Json::array();
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const double share = std::pow(motions[k].dot(product), 2);
      row.push_back(share > 1e-5 * whole[k] ? on_grid(share, whole[k]) : 0.0);
    }
    table.push_back(row);
  }
  return table;
}

}  // namespace

Json run_step(Context& context, const ModalOptions& options) {
  auto& system = context.system();
  system.begin_stage(context.boundary({}, true));
  auto& workspace = context.workspace();
  system.tangent(workspace.tangent);
  const auto mass = system.mass(options.mass);
  if (mass.norm_of_diagonal() == 0)
    throw ModelError(
        "nothing that can move has mass, so that there are no vibrations: give the materials a `density`, "
        "the "
        "sections a mass, or add point masses");
  context.progress.update(
      fmt::format("{} | {} modes of {} unknowns", context.step_name, options.modes, system.n_dofs()));
  const auto pairs = la::solve_vibration(workspace.tangent, mass, options.modes);
  workspace.solver.add(pairs.timings);
  // A rigid motion of a free structure has the eigenvalue zero, up to the rounding of the stiffness.
  const double rounding =
      1e-14 * workspace.tangent.norm_of_diagonal() / std::max(mass.norm_of_diagonal(), 1e-300);
  Json entry;
  entry["status"] = "done";
  entry["frequencies"] = Json::array();
  entry["effective_mass"] = effective_masses(system, mass, pairs);
  entry["residuals"] = Json::array();
  auto grid = field_grid(context, model::evaluate_response(system.model(), system.state()));
  grid.point_fields.clear();
  for (int i = 0; i < options.modes; ++i) {
    double eigenvalue = system.second_variation(pairs.vectors[i]);
    if (std::abs(eigenvalue) <= rounding) eigenvalue = 0;
    const double frequency =
        std::copysign(std::sqrt(std::abs(eigenvalue)), eigenvalue) / (2 * std::numbers::pi);
    entry["frequencies"].push_back(frequency);
    entry["residuals"].push_back(above_rounding(pairs.residuals[i], 1e-12));
    const Points shape = display_shape(system, pairs.vectors[i]);
    grid.point_fields.push_back(mode_field(fmt::format("mode {} ({:.4g} Hz)", i + 1, frequency), shape));
    if (i < 3 && context.draws())
      draw_mode(context, shape, fmt::format("mode_{}", i + 1),
                fmt::format("Mode {}: {:.4g} Hz", i + 1, frequency),
                fmt::format("Mode {}, {:.4g} Hz; light grey: at rest", i + 1, frequency));
    if (eigenvalue < -rounding) {
      entry["status"] = "not_converged";
      entry["reason"] =
          fmt::format("mode {} has a negative eigenvalue {:.3e}: the state is unstable", i + 1, eigenvalue);
    }
  }
  context.write_fields(context.step_name, grid);
  return entry;
}

}  // namespace tautline::steps
