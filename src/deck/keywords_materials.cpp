#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

Block make_material() {
  using Options = model::MaterialOptions;
  BlockBuilder<Options> b("materials", "", "A linear elastic material.");
  b.key("young_modulus", &Options::young_modulus)
      .in("Pa")
      .above(0)
      .required()
      .also_called({"E", "youngs_modulus", "elastic_modulus"})
      .says("Young's modulus.");
  b.key("poisson_ratio", &Options::poisson_ratio)
      .above(-1)
      .at_most(0.5)
      .also_called({"nu", "poisson"})
      .says("Poisson's ratio; beams and membranes of this material need it.");
  b.key("density", &Options::density)
      .in("kg/m^3")
      .at_least(0)
      .required()
      .also_called({"rho"})
      .says("Density.");
  b.key("thermal_expansion", &Options::thermal_expansion)
      .in("1/K")
      .also_called({"alpha", "cte"})
      .says("Coefficient of thermal expansion.");
  return b.take();
}

}  // namespace

const BlockSet& material_blocks() {
  static const BlockSet set{"materials", "Materials by name.", {make_material()}, {}};
  return set;
}

}  // namespace tautline::deck
