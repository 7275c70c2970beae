#include "steps/scatter.hpp"

#include <random>

#include <fmt/format.h>

#include <tautline/model/subdivide.hpp>

namespace tautline::steps {

namespace {

/// Evenly spread over [-1, 1); unlike the distributions of the standard library the same everywhere.
double spread(std::mt19937_64& random) {
  constexpr double unit = 0x1p-52;
  return static_cast<double>(random() >> 11) * unit - 1;
}

/// Of all free nodes of the system's mesh, as increments of its unknowns.
la::Vector displacements(Context& context, double largest, std::mt19937_64& random) {
  auto& system = context.system();
  system.begin_stage(context.boundary({}, false));  // tells what is held
  model::Model moved = context.structure;
  for (auto& node : moved.nodes)
    for (int c = 0; c < 3; ++c) node[c] += largest * spread(random);
  const Points there = model::subdivide(moved, context.subdivide).nodes;
  const Points here = model::subdivide(context.structure, context.subdivide).nodes;
  const auto& map = system.dof_map();
  la::Vector way(map.layout);
  way.set_zero();
  std::vector<double> own(static_cast<std::size_t>(way.local_size()), 0.0);
  for (std::size_t node = 0; node < map.displacement_block.size(); ++node) {
    const int block = map.displacement_block[node];
    if (block < 0 || !map.owns(block)) continue;
    for (int c = 0; c < 3; ++c)
      if (!system.held()[static_cast<std::size_t>(3 * block + c)])
        own[static_cast<std::size_t>(3 * (block - map.layout.first) + c)] = there[node][c] - here[node][c];
  }
  way.write(own);
  return way;
}

}  // namespace

void scatter(Context& context, const ScatterOptions& options) {
  if (options.position == 0 && options.tension == 0) return;
  auto& system = context.system();
  std::mt19937_64 random(static_cast<std::uint64_t>(options.seed));
  if (options.position > 0) system.move(displacements(context, options.position, random));
  if (options.tension > 0) {
    const auto wanted = system.strains();
    auto strains = wanted;
    for (double& strain : strains) strain *= 1 + options.tension * spread(random);
    system.set_state(system.state(), strains);
    system.set_target_strains(wanted);
  }
  system.commit();
  context.equilibrium_known = false;
  context.progress.say(
      fmt::format("{} | free nodes displaced by up to {:g} m in each coordinate, initial strains of cables "
                  "changed by up to {:g} of themselves, seed {}",
                  context.step_name, options.position, options.tension, options.seed));
}

}  // namespace tautline::steps
