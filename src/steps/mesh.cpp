#include <tautline/model/subdivide.hpp>

#include "steps/context.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

Json run_step(Context& context, const MeshOptions& options) {
  context.subdivide = options.subdivide;
  context.set_system(model::subdivide(context.described(), options.subdivide));
  const auto& system = context.system();
  Json entry = model_json(system.model(), system.n_dofs());
  entry["subdivisions"] = options.subdivide.subdivisions;
  entry["pattern"] = options.subdivide.pattern == model::FacetPattern::mapped ? "mapped" : "structured";
  context.note_model();
  entry["status"] = "done";
  return entry;
}

}  // namespace tautline::steps
