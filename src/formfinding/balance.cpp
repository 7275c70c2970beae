#include <formfinding/balance.hpp>

#include <fmt/format.h>

namespace tautline::formfinding {

Balance balance(const NetSystem& system, const NetState& state) {
  Balance result;
  const Coordinates force = nodal_forces(system.net(), state.force_density, state.vectors);
  result.reaction = to_points(-force);
  if (system.n_free() > 0)
    result.out_of_balance =
        system.unbalanced(force(system.free_nodes(), Eigen::all)).rowwise().norm().maxCoeff();
  return result;
}

std::vector<std::string> stability_warnings(const NetSystem& system, const NetState& state) {
  std::vector<std::string> warnings;
  const auto pressed = (state.force_density.array() < 0).count();
  Eigen::Index most = 0;
  if (pressed > 0) {
    const double q = state.force_density.minCoeff(&most);
    warnings.push_back(
        fmt::format("{} of {} branches are compression members; the most negative force density is "
                    "{:.4g} N/m, in branch {}",
                    pressed, system.n_branches(), q, most + 1));
  }
  if (const int unstable = system.negative_pivots(); unstable > 0)
    warnings.push_back(
        fmt::format("the equilibrium equations are indefinite, with {} negative eigenvalue(s): with its "
                    "force densities held, the net is in equilibrium but not stable",
                    unstable));
  return warnings;
}

}  // namespace tautline::formfinding
