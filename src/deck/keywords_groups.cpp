#include <algorithm>
#include <optional>
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
  const Node* nodes = node.find("nodes") != nullptr ? node.find("nodes") : node.find("edges");
  const std::string ways =
      "expected \"section\" for a group of elements, or \"nodes\" or \"edges\" for a set of nodes";
  if (section == nullptr && nodes == nullptr)
    reader.complain(node.label, "missing key \"section\", \"nodes\" or \"edges\"", reader.context(), ways);
  const BlockSet& set = group_blocks();
  if (nodes != nullptr)
    for (const auto& entry : node.entries)
      if (entry.key != "nodes" && entry.key != "edges" && set.alternatives.front().find(entry.key) != nullptr)
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

void read_edges(Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  for (const auto& item : node.items) {
    if (!reader.expect(Node::Kind::sequence, keyword, item)) continue;
    if (item.items.size() != 2 || !item.items[0].is_scalar() || !item.items[1].is_scalar()) {
      reader.complain(item, "an edge is no pair of nodes", "expected [node, node]");
      continue;
    }
    for (const auto& end : item.items) reader.refer("node", end);
    options.edges.push_back({item.items[0].text, item.items[1].text});
  }
}

/// all, or a list of what is free.
std::optional<model::EndRelease> read_release(Reader& reader, const Keyword& keyword, const Node& node) {
  static const std::vector<std::string> words{"torsion", "bending_2", "bending_3"};
  model::EndRelease release;
  if (node.is_scalar()) {
    if (node.text == "all") return model::EndRelease{{true, true, true}};
    reader.wrong_value(keyword, node, "is no known release", did_you_mean(node.text, {"all"}));
    return {};
  }
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return {};
  for (const auto& item : node.items) {
    const auto found = std::find(words.begin(), words.end(), item.text);
    if (found == words.end())
      reader.complain(item, fmt::format("unknown release \"{}\"", item.text),
                      "expected any of: " + join(words), did_you_mean(item.text, words));
    else
      release.free[static_cast<std::size_t>(found - words.begin())] = true;
  }
  return release;
}

template <class Member>
auto release_reader(Member member) {
  return [member](Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
    if (const auto release = read_release(reader, keyword, node)) options.*member = *release;
  };
}

Block make_group() {
  BlockBuilder<Options> b("groups", "",
                          "Section and initial state of a group of elements, or a named set of nodes.");
  b.key("section", &Options::section).refers("section").says("Section of all elements of the group.");
  b.key("nodes", &Options::nodes)
      .refers("node")
      .says("Instead of `section`: names of nodes, for supports and loads.");
  b.custom("edges", Type::edges, read_edges)
      .says(
          "Instead of `section`: sides of membranes or shells by their nodes, for supports and line loads; "
          "they are "
          "divided with the facets.");
  b.key("tension", &Options::tension)
      .in("N")
      .also_called({"force", "pretension"})
      .says("Cables and bars: initial tension; negative for bars in compression.");
  b.key("unstressed_length", &Options::unstressed_length)
      .in("m")
      .above(0)
      .also_called({"L0", "length"})
      .says("Cables: unstressed length of each.");
  b.key("force_density", &Options::force_density)
      .in("N/m")
      .also_called({"q"})
      .says("Cables and bars: initial tension over initial length; negative for bars in compression.");
  b.key("prestrain", &Options::prestrain)
      .above(-1)
      .says("Cables: initial length over unstressed length, minus one.");
  b.key("prestress", &Options::prestress)
      .in("N/m")
      .at_least(0)
      .says(
          "Membranes and shells: initial tension per width, the same in all directions, or along axes 1 and "
          "2.");
  b.key("initial_stress", &Options::initial_stress)
      .in("Pa")
      .says("Membranes and shells: instead of `prestress`, the stress; the section has a thickness.");
  b.key("orientation", &Options::orientation)
      .by_default("beams: [0, 0, 1]")
      .says(
          "Beams: local axis 3 lies in the plane of the beam and this vector; for a beam that is parallel to "
          "it, of the beam and [0, 0, 1], or [1, 0, 0] if it is vertical. Membranes and shells: axis 1 of "
          "orthotropic material and of unequal prestress is its projection on them; without it that of x, or "
          "of z where they stand across x.");
  b.custom("release_start", Type::releases, release_reader(&Options::release_start))
      .says(
          "Beams: rotations free at the first node: all (a ball joint), or a list of torsion, bending_2, "
          "bending_3.");
  b.custom("release_end", Type::releases, release_reader(&Options::release_end))
      .says("Beams: rotations free at the second node.");
  b.key("offset_start", &Options::offset_start)
      .in("m")
      .by_default("[0, 0, 0]")
      .says("Beams: from the first node to where the beam begins, a rigid arm.");
  b.key("offset_end", &Options::offset_end)
      .in("m")
      .by_default("[0, 0, 0]")
      .says("Beams: from the second node to where the beam ends, a rigid arm.");
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
