#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/response.hpp>

#include "steps/context.hpp"
#include "steps/linear_buckling.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/summaries.hpp"
#include "steps/fields.hpp"

namespace tautline::steps {

namespace {

Json failed(const std::string& reason) {
  return {{"status", "not_converged"}, {"reason", reason}};
}

void show_modes(Context& context, const LinearBuckling& found) {
  const auto& system = context.system();
  auto grid = field_grid(context, model::evaluate_response(system.model(), system.state()));
  grid.point_fields.clear();
  for (std::size_t i = 0; i < found.factors.size(); ++i) {
    const Points shape = display_shape(system, found.modes[i]);
    const std::string title = fmt::format("Buckling mode {}: load factor {:.5g}", i + 1, found.factors[i]);
    grid.point_fields.push_back(mode_field(title, shape));
    if (i < 3 && context.draws())
      draw_mode(context, shape, fmt::format("mode_{}", i + 1), title,
                title + "; light grey: before buckling");
  }
  context.write_fields(context.step_name, grid);
}

}  // namespace

Json run_step(Context& context, const BucklingOptions& options) {
  context.system();
  if (!context.is_supported({}))
    throw ModelError(
        "nothing is supported, and linear buckling of a structure that floats is not available: hold it "
        "statically determinate, with the forces of inertia as loads");
  const auto loads = scaled_loads(context, options.loads);
  if (const auto reason = come_to_rest(context); !reason.empty()) return failed(reason);
  context.progress.update(fmt::format("{} | {} modes", context.step_name, options.modes));
  const auto found = linear_buckling(context, loads, options.modes, options.sign);
  if (!found.failure.empty()) return failed(found.failure);
  Json entry{{"status", "done"}, {"loads", loads}};
  if (found.factors.empty())
    entry["reason"] = "no factor of the sign asked for: these loads make the structure buckle in no mode";
  entry["factors"] = Json::array();
  entry["residuals"] = Json::array();
  const double reference = reference_load(context, loads);
  if (reference > 0) entry["critical_loads"] = Json::array();
  for (std::size_t i = 0; i < found.factors.size(); ++i) {
    entry["factors"].push_back(found.factors[i]);
    entry["residuals"].push_back(found.residuals[i]);
    if (reference > 0) entry["critical_loads"].push_back(found.factors[i] * reference);
  }
  for (const auto& [sign, groups] : found.slack)
    if (!groups.empty()) entry["slack_at_first_factor"][sign] = groups;
  for (const auto& doubt : found.doubts) context.warn(doubt.code, doubt.message);
  show_modes(context, found);
  return entry;
}

}  // namespace tautline::steps
