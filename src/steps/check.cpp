#include <fmt/format.h>

#include <tautline/model/subdivide.hpp>
#include <tautline/steps/run.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

std::string check(const deck::Deck& deck) {
  const auto structure = build_structure(deck);
  model::validate(structure);
  return fmt::format("{}: {} nodes, {} cables, {} beams, {} membranes\n", deck.path, structure.nodes.size(), structure.cables.size(),
                     structure.beams.size(), structure.membranes.size());
}

}  // namespace tautline::steps
