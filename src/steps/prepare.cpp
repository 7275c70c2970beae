#include "steps/prepare.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/la/session.hpp>

#include "steps/linear_buckling.hpp"

namespace tautline::steps {

namespace {

/// Free unknowns that mass resists.
int unknowns_with_mass(const la::SymmetricMatrix& mass) {
  const auto sums = mass.absolute_row_sums();
  const auto own = std::count_if(sums.begin(), sums.end(), [](double sum) { return sum > 0; });
  return static_cast<int>(la::sum_over_ranks(static_cast<double>(own)));
}

}  // namespace

void prepare(Context& context, const ModalOptions& options) {
  auto& system = context.system();
  system.begin_stage(context.vibration_boundary(options.support));
  const int most = unknowns_with_mass(system.mass(options.mass));
  if (most == 0)
    throw ModelError(
        "nothing that can move has mass, so that there are no vibrations: give the materials a `density`, "
        "the sections a mass, or add point masses");
  if (options.modes > most)
    throw ModelError(
        fmt::format("only {} of the {} modes asked for exist: no more unknowns have mass. Ask for at most {}",
                    most, options.modes, most));
}

void prepare(Context& context, const BucklingOptions& options) {
  require_compression(context.system().model());
  const auto loads = scaled_loads(context, options.loads);
  context.system().begin_stage(boundary_with(context, loads, 1));
}

void prepare(Context& context, const CollapseOptions& options) {
  if (!options.linear_factor || options.imperfection.amplitude != 0)
    require_compression(context.system().model());
  const auto loads = scaled_loads(context, options.loads, options.disturbance);
  context.system().begin_stage(boundary_with(context, loads, 1));
}

}  // namespace tautline::steps
