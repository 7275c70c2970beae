#include <algorithm>
#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

using Options = model::GroupOptions;

/// A group is a section with its state or a set of nodes; a cable has one initial state.
void check_group(Reader& reader, const Node& node, Options& options) {
  const Node* section = node.find("section");
  const Node* nodes = node.find("nodes");
  const std::string ways = "expected \"section\" for a group of elements or \"nodes\" for a set of nodes";
  if (section == nullptr && nodes == nullptr)
    reader.complain(node.label, "missing key \"section\" or \"nodes\"", reader.context(), ways);
  const BlockSet& set = group_blocks();
  if (nodes != nullptr)
    for (const auto& entry : node.entries)
      if (entry.key != "nodes" && set.alternatives.front().find(entry.key) != nullptr)
        reader.complain(entry.place, fmt::format("\"{}\" does not fit a set of nodes", entry.key),
                        reader.context(), ways);
  if (options.orientation && options.orientation->isZero())
    reader.complain(*node.find("orientation"), "orientation has no direction",
                    "expected a vector that is not zero");
  const auto& states = initial_states();
  const Entry* first = nullptr;
  for (const auto& entry : node.entries) {
    if (std::find(states.begin(), states.end(), entry.key) == states.end()) continue;
    if (first != nullptr && first->key == entry.key) continue;
    if (first != nullptr)
      reader.complain(entry.place,
                      fmt::format("two initial states, \"{}\" and \"{}\"", first->key, entry.key),
                      reader.context(), "expected exactly one of: " + join(states));
    first = first == nullptr ? &entry : first;
  }
}

Block make_group() {
  BlockBuilder<Options> b("groups", "",
                          "Section and initial state of a group of elements, or a named set of nodes.");
  b.key("section", &Options::section).refers("section").says("Section of all elements of the group.");
  b.key("nodes", &Options::nodes)
      .refers("node")
      .says("Instead of `section`: names of nodes, for supports and loads.");
  b.key("tension", &Options::tension)
      .in("N")
      .at_least(0)
      .also_called({"force", "pretension"})
      .says("Cables: initial tension.");
  b.key("unstressed_length", &Options::unstressed_length)
      .in("m")
      .above(0)
      .also_called({"L0", "length"})
      .says("Cables: unstressed length of each.");
  b.key("force_density", &Options::force_density)
      .in("N/m")
      .above(0)
      .also_called({"q"})
      .says("Cables: initial tension over initial length.");
  b.key("prestrain", &Options::prestrain)
      .above(-1)
      .says("Cables: initial length over unstressed length, minus one.");
  b.key("prestress", &Options::prestress)
      .in("N/m")
      .at_least(0)
      .says("Membranes: initial tension per width, the same in all directions.");
  b.key("orientation", &Options::orientation)
      .says("Beams: local axis 3 lies in the plane of the beam and this vector.");
  b.check(check_group);
  return b.take();
}

}  // namespace

const std::vector<std::string>& initial_states() {
  static const std::vector<std::string> words{"tension", "unstressed_length", "force_density", "prestrain"};
  return words;
}

const BlockSet& group_blocks() {
  static const BlockSet set{"groups", "Groups by name.", {make_group()}, {}};
  return set;
}

}  // namespace tautline::deck
