#include <algorithm>
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

/// One element: one to four different node names.
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
  if (names.empty() || names.size() > 4)
    reader.complain(node, fmt::format("an element of {} nodes", names.size()),
                    "expected 2 nodes for a cable or beam, 3 or 4 for a membrane or shell, 1 for a mass");
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

/// [[node, direction, coefficient], ...]
void read_terms(Reader& reader, const Keyword& keyword, const Node& node, model::ConstraintOptions& options) {
  static const std::vector<std::string> directions{"x", "y", "z"};
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  Keyword number = keyword;
  number.type = Type::number;
  number.name = "coefficient";
  for (const auto& item : node.items) {
    if (!item.is_sequence() || item.items.size() != 3) {
      reader.complain(item, "a term is no [node, direction, coefficient]", "e.g. [tip, x, -1]");
      continue;
    }
    model::ConstraintTermOptions term;
    reader.refer("node", item.items[0]);
    term.node = item.items[0].text;
    const auto found = std::find(directions.begin(), directions.end(), item.items[1].text);
    if (found == directions.end()) {
      reader.complain(item.items[1], fmt::format("unknown direction \"{}\"", item.items[1].text),
                      "expected x, y or z");
      continue;
    }
    term.component = static_cast<int>(found - directions.begin());
    const auto value = reader.number(number, item.items[2]);
    if (value && *value == 0) reader.complain(item.items[2], "a coefficient of 0 says nothing");
    term.coefficient = value.value_or(1);
    options.terms.push_back(std::move(term));
  }
  if (options.terms.size() < 2)
    reader.complain(node, "a linear constraint needs at least two terms", {},
                    "a support holds a single direction");
}

const BlockSet& constraint_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<model::ConstraintOptions> b("model.constraints", "",
                                             "A linear constraint: the sum of its terms is zero.");
    b.custom("terms", Type::terms, read_terms)
        .required()
        .says("Terms [node, direction, coefficient]; the displacement of the first follows from the others.");
    return BlockSet{"model.constraints", "Linear constraints.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& cyclic_blocks() {
  using Cyclic = model::CyclicOptions;
  static const BlockSet set = [] {
    BlockBuilder<Cyclic> b("model.cyclic", "",
                           "Two faces of a sector: the nodes of one move as those of the other, turned.");
    b.key("from", &Cyclic::from).required().refers("group").says("Nodes that lead.");
    b.key("to", &Cyclic::to).required().refers("group").says("Nodes that follow, one at each turned place.");
    b.key("angle", &Cyclic::angle)
        .in("degree")
        .required()
        .says("Angle from the leading to the following face.");
    b.key("axis", &Cyclic::axis).by_default("[0, 0, 1]").says("Direction of the axis.");
    b.key("centre", &Cyclic::centre).in("m").by_default("[0, 0, 0]").says("A point of the axis.");
    b.check([](Reader& reader, const Node& node, Cyclic& o) {
      if (o.axis.isZero(0))
        reader.complain(*node.find("axis"), "axis has no direction", "expected a vector that is not zero");
    });
    return BlockSet{"model.cyclic", "Cyclic symmetry.", {b.take()}, {}};
  }();
  return set;
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
      .says(
          "Elements of each group as lists of node names: 1 for masses and springs to the ground, 2 for "
          "cables, "
          "bars, beams, links and springs, 3 or 4 in order around membranes and shells.");
  b.key("mesh", &Options::mesh_file)
      .says(
          "Instead of nodes and elements: a gmsh file (.msh), relative to the deck's folder. Its physical "
          "groups are the groups; nodes are numbered anew, see form_finding_nodes.csv.");
  b.list("constraints", &Options::constraints, constraint_blocks())
      .says("Linear constraints between displacements.");
  b.list("cyclic", &Options::cyclic, cyclic_blocks()).says("Cyclic symmetry between two faces of a sector.");
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
