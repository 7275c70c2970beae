#include <algorithm>
#include <array>
#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

constexpr std::array<const char*, 6> directions{"x", "y", "z", "rx", "ry", "rz"};

/// all, pinned, or a list of directions.
void read_fix(Reader& reader, const Keyword& keyword, const Node& node, model::SupportOptions& options) {
  if (node.is_scalar() && (node.text == "all" || node.text == "pinned")) {
    for (std::size_t i = 0; i < 6; ++i) options.fixed[i] = i < 3 || node.text == "all";
    return;
  }
  if (node.is_scalar())
    return reader.wrong_value(keyword, node, "is no known support",
                              did_you_mean(node.text, {"all", "pinned"}));
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  if (node.items.empty()) return reader.wrong_value(keyword, node, "is an empty list");
  options.fixed.fill(false);
  for (const auto& item : node.items) {
    const auto* found =
        std::find_if(directions.begin(), directions.end(), [&](const char* d) { return item.text == d; });
    if (found == directions.end())
      reader.complain(item, fmt::format("unknown direction \"{}\"", item.text),
                      "expected any of: x, y, z, rx, ry, rz");
    else
      options.fixed[static_cast<std::size_t>(found - directions.begin())] = true;
  }
}

void check_not_empty(Reader& reader, const Node& node) {
  if (const Node* on = node.find("on"); on != nullptr && on->is_sequence() && on->items.empty())
    reader.complain(*on, "\"on\" is an empty list", "expected at least one group or selection");
}

Block make_support() {
  using Options = model::SupportOptions;
  BlockBuilder<Options> b("supports", "", "Nodes that cannot move.");
  b.key("name", &Options::name).by_default("support and its number").says("Name for messages and results.");
  b.key("on", &Options::on).required().refers("group").says("Groups or selections whose nodes are fixed.");
  b.custom("fix", Type::directions, read_fix)
      .by_default("all")
      .says("Fixed directions: all (displacements and rotations), pinned (x, y, z), or a list.");
  b.check([](Reader& reader, const Node& node, Options&) { check_not_empty(reader, node); });
  return b.take();
}

void check_load(Reader& reader, const Node& node, model::LoadOptions&) {
  check_not_empty(reader, node);
  const bool nodal = node.find("force") != nullptr || node.find("moment") != nullptr;
  const Node* acceleration = node.find("acceleration");
  if (!nodal && acceleration == nullptr)
    reader.complain(node.label, "missing key \"force\", \"moment\" or \"acceleration\"", reader.context(),
                    "expected force or moment (with on), or acceleration");
  if (nodal && node.find("on") == nullptr)
    reader.complain(node.label, "missing key \"on\"", reader.context(),
                    "expected the groups or selections whose nodes are loaded");
  if (acceleration != nullptr && !nodal && node.find("on") != nullptr)
    reader.complain(*node.find("on"), "\"on\" has no effect: an acceleration acts on every mass");
}

Block make_load() {
  using Options = model::LoadOptions;
  BlockBuilder<Options> b("loads", "", "A load, ramped up from zero; its direction stays.");
  b.key("name", &Options::name).required().says("Name; steps refer to it.");
  b.key("on", &Options::on).refers("group").says("Groups or selections whose nodes are loaded.");
  b.key("force", &Options::force).in("N").by_default("[0, 0, 0]").says("Force on each node.");
  b.key("moment", &Options::moment).in("N m").by_default("[0, 0, 0]").says("Moment on each node.");
  b.key("acceleration", &Options::acceleration)
      .in("m/s^2")
      .says("Acceleration that acts on every mass, e.g. gravity [0, 0, -9.81]; needs no `on`.");
  b.check(check_load);
  return b.take();
}

}  // namespace

const BlockSet& support_blocks() {
  static const BlockSet set{"supports", "Supports.", {make_support()}, {}};
  return set;
}

const BlockSet& load_blocks() {
  static const BlockSet set{"loads", "Loads.", {make_load()}, {}};
  return set;
}

}  // namespace tautline::deck
