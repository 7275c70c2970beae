#include <fmt/format.h>

#include <deck/cross_checks.hpp>
#include <deck/keywords.hpp>
#include <deck/parameters.hpp>
#include <deck/reader.hpp>
#include <deck/yaml_tree.hpp>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <tautline/core/sha256.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

constexpr std::size_t most_bytes = 100'000'000;  ///< of a deck

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  Diagnostic diagnostic;
  diagnostic.where.file = path;
  diagnostic.message = message;
  throw DeckError({diagnostic});
}

std::string read_bytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail(path, "this file does not exist");
  if (std::filesystem::is_directory(path, error)) fail(path, "this is a folder, not a deck");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, "this file cannot be read");
  std::string text;
  std::array<char, 65536> part{};
  while (file.read(part.data(), part.size()) || file.gcount() > 0) {
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > most_bytes) fail(path, fmt::format("this file has more than {} bytes", most_bytes));
  }
  if (file.bad()) fail(path, "this file cannot be read");
  return text;
}

std::string without_byte_order_mark(const std::string& text) {
  return text.rfind("\xEF\xBB\xBF", 0) == 0 ? text.substr(3) : text;
}

/// The values of a tree as text in which layout, comments and where they come from do not show.
void write_values(const Node& node, std::string& to) {
  switch (node.kind) {
    case Node::Kind::scalar:
      to += fmt::format("{}:{};", node.text.size(), node.text);
      return;
    case Node::Kind::sequence:
      to += '[';
      for (const auto& item : node.items) write_values(item, to);
      to += ']';
      return;
    case Node::Kind::mapping:
      to += '{';
      for (const auto& entry : node.entries) {
        to += fmt::format("{}:{}=", entry.key.size(), entry.key);
        write_values(entry.value, to);
      }
      to += '}';
      return;
    default:
      to += '~';
  }
}

/// Of what a mesh file holds; a file that cannot be read is complained of elsewhere.
std::string content_fingerprint(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  std::ifstream file(path, std::ios::binary);
  return sha256(std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
}

void take_fingerprints(Deck& deck, const Node& root) {
  std::string rest;
  for (const auto& entry : root.entries) {
    const auto& key = entry.key;
    if (key == "steps" || key == "title" || key == "output" || key == "parameters" || key == "solver")
      continue;
    rest += key;
    write_values(entry.value, rest);
  }
  if (deck.model && !deck.model->mesh_file.empty()) rest += content_fingerprint(deck.model->mesh_file);
  deck.fingerprint = sha256(rest);
  if (const Node* steps = root.find("steps"))
    for (const auto& step : steps->items) {
      std::string text;
      write_values(step, text);
      deck.step_fingerprints.push_back(sha256(text));
    }
}

/// Puts in what the tree says but options do not read themselves: kinds and names left out.
void complete(Deck& deck, const Node& root) {
  for (std::size_t i = 0; i < deck.steps.size(); ++i) {
    const Node* kind = root.at({"steps", std::to_string(i), "kind"});
    if (kind != nullptr && step_blocks().find(kind->text) != nullptr) deck.steps[i].kind = kind->text;
    if (auto* equilibrium = std::get_if<steps::EquilibriumOptions>(&deck.steps[i].options))
      for (std::size_t k = 0; k < equilibrium->stages.size(); ++k)
        if (auto& name = equilibrium->stages[k].name; name.empty()) name = fmt::format("stage {}", k + 1);
  }
  for (std::size_t i = 0; i < deck.supports.size(); ++i)
    if (auto& name = deck.supports[i].name; name.empty()) name = fmt::format("support {}", i + 1);
}

}  // namespace

Deck parse_deck(const std::string& bytes, const std::string& name,
                const std::vector<std::string>& overrides) {
  const std::string text = without_byte_order_mark(bytes);
  const Source source(name, text);
  Complaints complaints;
  Node root = parse_yaml(source, text);
  apply_overrides(root, overrides, complaints);
  substitute_parameters(root, source, complaints);

  Deck deck;
  Reader reader(source, complaints);
  reader.read_block(root_blocks(), root, &deck);
  deck.path = name;
  deck.sha256 = sha256(bytes);
  complete(deck, root);
  const Names names(deck, root);
  check_references(names, reader);
  check_groups(deck, names, root, reader);
  check_model(deck, names, root, reader);
  check_steps(deck, names, root, reader);
  take_fingerprints(deck, root);
  complaints.throw_if_any();
  return deck;
}

Deck read_deck(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_deck(read_bytes(path), path, overrides);
}

}  // namespace tautline::deck
