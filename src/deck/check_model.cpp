#include <fmt/format.h>

#include <deck/cross_checks.hpp>
#include <filesystem>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

/// Least and most nodes of an element.
std::pair<std::size_t, std::size_t> arity(Member member) {
  if (member == Member::membrane || member == Member::shell) return {3, 4};
  if (member == Member::spring) return {1, 2};
  if (member == Member::mass) return {1, 1};
  return {2, 2};
}

/// Every element of a group has as many nodes as its section wants.
void check_arity(const Names& names, const Node& elements, Reader& reader) {
  for (const auto& [group, place, list] : elements.entries) {
    const auto member = names.member(group);
    if (!member) continue;
    const auto [least, most] = arity(*member);
    for (const auto& element : list.items) {
      const std::size_t n = element.items.size();
      if ((n >= least && n <= most) || n < 1 || n > 4) continue;
      reader.complain(element.place,
                      fmt::format("an element of {} nodes in group \"{}\", which is made of {}", n, group,
                                  to_string(*member)),
                      context_text({"model", "elements", group}),
                      least == most ? fmt::format("expected {} node{}", least, least == 1 ? "" : "s")
                                    : fmt::format("expected {} or {} nodes", least, most));
    }
  }
}

/// No element joins two nodes at the same place.
void check_lengths(const Deck& deck, const Names& names, const Node& elements, Reader& reader) {
  std::map<std::string, Vec3> position(deck.model->nodes.begin(), deck.model->nodes.end());
  for (const auto& [group, place, list] : elements.entries) {
    const auto member = names.member(group);
    if (member == Member::spring || member == Member::link) continue;  // these may be without length
    for (const auto& element : list.items)
      for (std::size_t i = 0; i < element.items.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const auto a = position.find(element.items[j].text), b = position.find(element.items[i].text);
          if (a == position.end() || b == position.end() || a->first == b->first || a->second != b->second)
            continue;
          reader.complain(element.place,
                          fmt::format("nodes \"{}\" and \"{}\" are at the same place", a->first, b->first),
                          context_text({"model", "elements", group}), "expected an element with a length");
        }
  }
}

void check_mesh_file(Deck& deck, const Node& mesh, Reader& reader) {
  namespace fs = std::filesystem;
  const fs::path file = fs::path(deck.path).parent_path() / deck.model->mesh_file;
  std::error_code error;
  if (!fs::exists(file, error))
    reader.complain(mesh.place, fmt::format("mesh file \"{}\" does not exist", file.string()), "in model",
                    "expected a path relative to the deck's folder");
  else if (fs::is_directory(file, error))
    reader.complain(mesh.place, fmt::format("mesh file \"{}\" is a folder", file.string()), "in model");
  else if (!fs::is_regular_file(file, error))
    reader.complain(mesh.place, fmt::format("mesh file \"{}\" is a device or a pipe", file.string()),
                    "in model", "expected a file");
  deck.model->mesh_file = file.string();
}

}  // namespace

void check_model(Deck& deck, const Names& names, const Node& root, Reader& reader) {
  if (!deck.model) return;
  const Node* mesh = root.at({"model", "mesh"});
  const Node* elements = root.at({"model", "elements"});
  if (mesh != nullptr && mesh->is_scalar()) check_mesh_file(deck, *mesh, reader);
  if (elements == nullptr || !elements->is_mapping()) return;
  check_arity(names, *elements, reader);
  check_lengths(deck, names, *elements, reader);
}

}  // namespace tautline::deck
