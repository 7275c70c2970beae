#include <fmt/format.h>

#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

void read_parameters(Reader& reader, const Keyword& keyword, const Node& node, Deck& deck) {
  if (!reader.expect(Node::Kind::mapping, keyword, node)) return;
  const Reader::Step step(reader, keyword.name);
  reader.check_duplicates(node);
  for (const auto& [name, place, value] : node.entries) {
    if (value.is_scalar())
      deck.parameters[name] = value.text;
    else
      reader.complain(value, fmt::format("parameter \"{}\" is {}", name, value.describe()),
                      "expected a number or a text");
  }
}

void read_units(Reader& reader, const Keyword& keyword, const Node& node, Deck&) {
  reader.choice(keyword, node);
}

void check_structure(Reader& reader, const Node& node, Deck&) {
  const Node* reflector = node.find("reflector");
  const Node* model = node.find("model");
  if (reflector != nullptr && model != nullptr)
    reader.complain(
        std::max(reflector->label.line, model->label.line) == model->label.line ? model->label
                                                                                : reflector->label,
        "both \"reflector\" and \"model\" are given", reader.context(), "expected exactly one of them");
  if (reflector == nullptr && model == nullptr)
    reader.complain(Place(), "missing key \"reflector\" or \"model\"", reader.context(),
                    "expected exactly one of them: the structure to be analysed");
}

/// A reflector that needs nothing else; one of an unknown kind is complained about already.
bool is_complete(const Node& node) {
  const Node* kind = node.at({"reflector", "kind"});
  return kind != nullptr &&
         (is_complete_structure(kind->text) || reflector_blocks().find(kind->text) == nullptr);
}

void check_needless(Reader& reader, const Node& node, Deck& deck) {
  if (deck.rod_umbrella() == nullptr) return;
  for (const char* key : {"materials", "sections", "groups", "supports"})
    if (const Node* block = node.find(key))
      reader.complain(block->label, fmt::format("\"{}\" has no effect on a rod-umbrella", key),
                      reader.context(), {}, "its block \"reflector\" tells all of it");
}

Block make_root() {
  BlockBuilder<Deck> b("", "", "A deck describes one structure and what is done with it.");
  b.key("title", &Deck::title).says("Title for reports.");
  b.custom("units", Type::choice, read_units)
      .one_of({"SI"})
      .by_default("SI")
      .says("System of units; all values of a deck are SI: m, N, Pa, kg, s, Hz.");
  b.custom("parameters", Type::parameters, read_parameters)
      .says(
          "Named values. `${name}` stands for the value anywhere else in the deck (in quotes inside "
          "brackets); "
          "`--set parameters.name=value` changes it.");
  b.block("reflector", &Deck::reflector, reflector_blocks()).says("A parametric reflector; or give `model`.");
  b.block("model", &Deck::model, model_blocks())
      .says("A structure of named nodes or from a mesh file; or give `reflector`.");
  b.map("materials", &Deck::materials, material_blocks()).says("Materials by name.");
  b.map("sections", &Deck::sections, section_blocks())
      .required_unless(is_complete)
      .says(
          "Sections of cables, beams, membranes, shells and other elements by name; a rod-umbrella needs "
          "none.");
  b.map("groups", &Deck::groups, group_blocks())
      .required_unless(is_complete)
      .says(
          "Section and initial state of each group of elements, by the group's name; or named sets of "
          "nodes. A rod-umbrella needs none.");
  b.list("supports", &Deck::supports, support_blocks()).says("Fixed nodes.");
  b.list("loads", &Deck::loads, load_blocks()).says("Loads, ramped up by `equilibrium` steps.");
  b.list("steps", &Deck::steps, step_blocks())
      .required()
      .says("What is done, in order; each step goes on from the state the one before left.");
  b.block("output", &Deck::output, output_blocks()).says("Which results are written.");
  b.block("solver", &Deck::solver, solver_blocks()).says("Newton's method in all steps.");
  b.check([](Reader& reader, const Node& node, Deck& deck) {
    check_structure(reader, node, deck);
    check_needless(reader, node, deck);
  });
  return b.take();
}

}  // namespace

const BlockSet& root_blocks() {
  static const BlockSet set{"", "", {make_root()}, {}};
  return set;
}

}  // namespace tautline::deck
