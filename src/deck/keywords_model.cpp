#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <set>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

using Options = model::ModelOptions;

void read_nodes(Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
  if (!reader.expect(Node::Kind::mapping, keyword, node)) return;
  const Reader::Step step(reader, keyword.name);
  reader.check_duplicates(node);
  Keyword point = keyword;
  point.type = Type::vector;
  for (const auto& entry : node.entries) {
    point.name = fmt::format("node \"{}\"", entry.key);
    if (const auto position = reader.vector(point, entry.value))
      options.nodes.emplace_back(entry.key, *position);
  }
}

/// One element: two or three different node names.
void read_element(Reader& reader, const Keyword& keyword, const Node& node,
                  std::vector<std::vector<std::string>>& list) {
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  std::vector<std::string> names;
  std::set<std::string> different;
  for (const auto& item : node.items) {
    if (!reader.expect(Node::Kind::scalar, keyword, item)) return;
    reader.refer("node", item);
    if (!different.insert(item.text).second)
      reader.complain(item, fmt::format("node \"{}\" stands twice in one element", item.text));
    names.push_back(item.text);
  }
  if (names.size() < 2 || names.size() > 3)
    reader.complain(node, fmt::format("an element of {} node{}", names.size(), names.size() == 1 ? "" : "s"),
                    "expected 2 nodes for a cable or beam, 3 for a membrane");
  list.push_back(std::move(names));
}

void read_elements(Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
  if (!reader.expect(Node::Kind::mapping, keyword, node)) return;
  const Reader::Step step(reader, keyword.name);
  reader.check_duplicates(node);
  for (const auto& entry : node.entries) {
    Keyword self = keyword;
    self.name = entry.key;
    if (!reader.expect(Node::Kind::sequence, self, entry.value)) continue;
    const Reader::Step group(reader, entry.key);
    model::InlineElements elements;
    elements.group = entry.key;
    elements.where = reader.source().where(entry.place);
    for (const auto& item : entry.value.items) read_element(reader, self, item, elements.connectivity);
    if (elements.connectivity.empty())
      reader.complain(entry.value, fmt::format("group \"{}\" has no elements", entry.key));
    options.elements.push_back(std::move(elements));
  }
}

void check_model(Reader& reader, const Node& node, Options& options) {
  const Node* mesh = node.find("mesh");
  const Node* nodes = node.find("nodes");
  const Node* elements = node.find("elements");
  const std::string ways = "expected either mesh, or nodes + elements";
  if (mesh != nullptr) options.mesh_where = reader.source().where(mesh->place);
  if (mesh != nullptr && (nodes != nullptr || elements != nullptr))
    reader.complain(mesh->label, "both a mesh file and inline nodes or elements are given", reader.context(),
                    ways);
  else if (mesh == nullptr && (nodes == nullptr || elements == nullptr))
    reader.complain(node.label,
                    nodes == nullptr && elements == nullptr
                        ? "missing keys \"nodes\", \"elements\""
                        : fmt::format("missing key \"{}\"", nodes == nullptr ? "nodes" : "elements"),
                    reader.context(), ways);
}

Block make_model() {
  BlockBuilder<Options> b("model", "", "A structure of named nodes and elements, or a mesh file.");
  b.custom("nodes", Type::coordinates, read_nodes).in("m").says("Coordinates of each node, by its name.");
  b.custom("elements", Type::elements, read_elements)
      .says("Elements of each group as lists of node names: 2 for cables and beams, 3 for membranes.");
  b.key("mesh", &Options::mesh_file)
      .says(
          "Instead of nodes and elements: a gmsh file (.msh), relative to the deck's folder. Its physical "
          "groups are the groups.");
  b.check(check_model);
  return b.take();
}

}  // namespace

const BlockSet& model_blocks() {
  static const BlockSet set{
      "model", "A structure of named nodes and elements, or a mesh file.", {make_model()}, {}};
  return set;
}

}  // namespace tautline::deck
