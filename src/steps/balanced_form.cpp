#include "steps/balanced_form.hpp"

#include <vector>

namespace tautline::steps {

VecX balancing(const Context& context, const FormNet& form, const formfinding::BalancedOptions& options) {
  VecX wanted(form.cables.size());
  std::vector<bool> held(form.cables.size(), false);
  for (const auto& name : form.groups) {
    const auto& group = context.deck.groups.at(name);
    for (const int b : form.branches_of(context.structure, {name})) {
      const auto [i, j] = form.net.branches[b];
      wanted[b] = form.drawn_tension[b];
      if (!group.force_density) continue;
      held[static_cast<std::size_t>(b)] = true;
      wanted[b] = *group.force_density * (form.net.nodes[j] - form.net.nodes[i]).norm();
    }
  }
  try {
    return formfinding::balancing_force_densities(form.net, wanted, held, form.surface, options);
  } catch (const formfinding::NetError& error) {
    throw named(context, form, error);
  }
}

}  // namespace tautline::steps
