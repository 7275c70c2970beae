#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include <fmt/format.h>

#include <tautline/assembly/bodies.hpp>
#include <tautline/core/text.hpp>
#include <tautline/la/eigen_solver.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/names.hpp>
#include <tautline/model/response.hpp>

#include "steps/context.hpp"
#include "steps/free_modes.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/prepare.hpp"
#include "steps/summaries.hpp"
#include "steps/fields.hpp"

namespace tautline::steps {

namespace {

/// Unit rigid motions about the origin in the current positions: three translations, three rotations.
std::vector<la::Vector> unit_motions(const assembly::System& system) {
  std::vector<int> nodes(system.model().nodes.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::vector<la::Vector> motions;
  for (const auto& motion : assembly::unit_motions(Vec3::Zero())) {
    const auto values = assembly::unknowns_of(system, nodes, motion);
    const auto& layout = system.layout();
    auto& vector = motions.emplace_back(layout);
    vector.write(std::span(values).subspan(static_cast<std::size_t>(3 * layout.first),
                                           static_cast<std::size_t>(3 * layout.local)));
  }
  return motions;
}

/// What a mode may hold of its neighbours: the last digit of its eigenvalue over the distance to the nearest
/// other one; all of it among equal ones, where only the sum over them is defined.
double strange_part(const la::EigenPairs& pairs, std::size_t mode) {
  constexpr double sharpness = 1e-12;  // of the eigenvalues, over the largest found
  double distance = std::numeric_limits<double>::infinity(), largest = 0;
  for (std::size_t i = 0; i < pairs.values.size(); ++i) {
    largest = std::max(largest, std::abs(pairs.values[i]));
    if (i != mode) distance = std::min(distance, std::abs(pairs.values[i] - pairs.values[mode]));
  }
  return std::min(1.0, distance > 0 ? sharpness * largest / distance : 1.0);
}

/// Adds (r^T M phi)^2 for modes normalised to phi^T M phi = 1, the mass that takes part [kg], [kg m^2]; and
/// the level below which that means nothing: the whole mass times the square of what a mode lacks in
/// sharpness.
void add_effective_masses(const assembly::System& system, const la::SymmetricMatrix& mass,
                          const la::EigenPairs& pairs, Json& entry) {
  const auto motions = unit_motions(system);
  Json table = Json::array(), levels = Json::array();
  la::Vector product(system.layout());
  std::vector<double> whole;
  for (const auto& motion : motions) {
    mass.multiply(motion, product);
    whole.push_back(motion.dot(product));
  }
  for (std::size_t i = 0; i < pairs.vectors.size(); ++i) {
    mass.multiply(pairs.vectors[i], product);
    const double part = std::pow(strange_part(pairs, i), 2);
    Json row = Json::array(), level = Json::array();
    for (std::size_t k = 0; k < motions.size(); ++k) {
      row.push_back(std::pow(motions[k].dot(product), 2));
      level.push_back(part * whole[k]);
    }
    table.push_back(row);
    levels.push_back(level);
  }
  entry["effective_mass"] = table;
  entry["effective_mass_rounding"] = levels;
}

/// What can move without resistance: told by the node that each motion moves most.
void warn_of_mechanisms(Context& context, const la::EigenPairs& mechanisms) {
  const auto& system = context.system();
  std::vector<std::string> places;
  for (const auto& mode : mechanisms.vectors) {
    const auto field = system.nodal(mode);
    const auto size = [&](std::size_t i) {
      return field.displacement[i].norm() + system.size() * field.rotation[i].norm();
    };
    std::size_t most = 0;
    for (std::size_t i = 1; i < field.displacement.size(); ++i)
      if (size(i) > (1 + 1e-6) * size(most)) most = i;
    const auto place = model::node_at(system.model(), static_cast<int>(most));
    if (places.size() < 5 && std::find(places.begin(), places.end(), place) == places.end())
      places.push_back(place);
  }
  const auto n = mechanisms.vectors.size();
  context.warn("mechanism",
               fmt::format("{} mode{} without frequency beside those of a rigid body {} left out: parts of "
                           "the structure move against each other without resistance, most of all {}",
                           n, n == 1 ? "" : "s", n == 1 ? "is" : "are", join(places, ", ")));
}

/// Modes of the state, rigid ones and mechanisms left out and counted in the entry.
la::EigenPairs solve(Context& context, const ModalOptions& options, const la::SymmetricMatrix& mass,
                     Json& entry) {
  auto& system = context.system();
  const auto& stiffness = context.workspace().tangent;
  const auto rigid = rigid_modes(system, stiffness, mass);
  entry["rigid_modes"] = rigid.modes.size() + rigid.massless.size();
  entry["mechanisms"] = 0;
  if (entry["rigid_modes"] == 0) try {
      return la::solve_vibration(stiffness, mass, options.modes);
    } catch (const LibraryError&) {  // no factors: mechanisms, which the next attempt tells
    }
  auto found = solve_free(system, stiffness, mass, rigid, options.modes);
  entry["mechanisms"] = found.mechanisms.vectors.size();
  if (!found.mechanisms.vectors.empty()) warn_of_mechanisms(context, found.mechanisms);
  return std::move(found.elastic);
}

/// A mode without frequency is a motion that nothing resists, or a state about to become unstable.
void warn_of_still_modes(Context& context, const Json& entry) {
  const double level = entry["frequency_rounding"];
  std::vector<std::string> still;
  for (std::size_t i = 0; i < entry["frequencies"].size(); ++i)
    if (std::abs(entry["frequencies"][i].get<double>()) <= level) still.push_back(std::to_string(i + 1));
  if (still.empty()) return;
  context.warn(
      "no_frequency",
      fmt::format("mode{} {} {} no frequency above its rounding of {:.2g} Hz: nothing resists that motion. "
                  "Give cables and cloth a tension, or support what moves",
                  still.size() == 1 ? "" : "s", join(still, ", "), still.size() == 1 ? "has" : "have",
                  level));
}

}  // namespace

Json run_step(Context& context, const ModalOptions& options) {
  auto& system = context.system();
  prepare(context, options);
  auto& workspace = context.workspace();
  system.tangent(workspace.tangent);
  const auto mass = system.mass(options.mass);
  context.progress.update(
      fmt::format("{} | {} modes of {} unknowns", context.step_name, options.modes, system.n_dofs()));
  Json entry;
  entry["status"] = "done";
  const auto pairs = solve(context, options, mass, entry);
  workspace.solver.add(pairs.timings);
  // The level below which an eigenvalue is the rounding of the stiffness.
  const double rounding =
      1e-14 * workspace.tangent.norm_of_diagonal() / std::max(mass.norm_of_diagonal(), 1e-300);
  entry["frequencies"] = Json::array();
  entry["frequency_rounding"] = std::sqrt(rounding) / (2 * std::numbers::pi);
  add_effective_masses(system, mass, pairs, entry);
  entry["residuals"] = Json::array();
  const bool floats = entry["rigid_modes"] != 0;
  auto grid = field_grid(context, model::evaluate_response(system.model(), system.state()));
  grid.point_fields.clear();
  for (int i = 0; i < options.modes; ++i) {
    const double eigenvalue = system.second_variation(pairs.vectors[i]);
    const double frequency =
        std::copysign(std::sqrt(std::abs(eigenvalue)), eigenvalue) / (2 * std::numbers::pi);
    entry["frequencies"].push_back(frequency);
    entry["residuals"].push_back(pairs.residuals[i]);
    const Points shape = display_shape(system, pairs.vectors[i]);
    grid.point_fields.push_back(mode_field(fmt::format("mode {} ({:.4g} Hz)", i + 1, frequency), shape));
    if (i < 3 && context.draws())
      draw_mode(context, shape, fmt::format("mode_{}", i + 1),
                fmt::format("Mode {}: {:.4g} Hz", i + 1, frequency),
                fmt::format("Mode {}, {:.4g} Hz; light grey: at rest", i + 1, frequency));
    if (eigenvalue < -rounding) {
      entry["status"] = "not_converged";
      entry["reason"] =
          fmt::format("mode {} has a negative eigenvalue {:.3e}: the state is unstable", i + 1, eigenvalue) +
          (floats && !context.acting_loads.empty()
               ? "; the structure floats, and its loads keep their direction while it turns: for its "
                 "vibrations without them, take them off by an equilibrium step with support: free, loads: []"
               : "");
    }
  }
  warn_of_still_modes(context, entry);
  context.write_fields(context.step_name, grid);
  return entry;
}

}  // namespace tautline::steps
