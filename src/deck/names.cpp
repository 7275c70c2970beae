#include <fmt/format.h>

#include <algorithm>
#include <deck/cross_checks.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

const std::map<std::string, Member>& reflector_groups() {
  static const std::map<std::string, Member> table{{"front_net", Member::cable}, {"rear_net", Member::cable},
                                                   {"ties", Member::cable},      {"diagonals", Member::cable},
                                                   {"front_rim", Member::beam},  {"rear_rim", Member::beam},
                                                   {"struts", Member::beam},     {"cloth", Member::membrane}};
  return table;
}

const std::vector<std::string>& reflector_selections() {
  static const std::vector<std::string> list{"held_strut", "front_net_nodes", "rear_net_nodes",
                                             "front_rim_nodes", "rear_rim_nodes"};
  return list;
}

/// The number k of "strut_<k>", or -1.
int strut_number(const std::string& name) {
  return name.rfind("strut_", 0) == 0 ? list_index(name.substr(6)) : -1;
}

std::vector<std::string> keys(const Node* node) {
  std::vector<std::string> result;
  std::set<std::string_view> seen;
  if (node != nullptr)
    for (const auto& entry : node->entries)
      if (seen.insert(entry.key).second) result.push_back(entry.key);
  return result;
}

}  // namespace

std::string to_string(Member member) {
  switch (member) {
    case Member::cable:
      return "cables";
    case Member::bar:
      return "bars";
    case Member::catenary:
      return "catenaries";
    case Member::beam:
      return "beams";
    case Member::membrane:
      return "membranes";
    case Member::shell:
      return "shells";
    case Member::spring:
      return "springs";
    case Member::mass:
      return "masses";
    case Member::link:
      return "links";
  }
  return {};
}

bool is_line_with_state(Member member) {
  return member == Member::cable || member == Member::bar || member == Member::catenary;
}

Names::Names(const Deck& deck, const Node& root) : root_(root) {
  const Node* elements = root.at({"model", "elements"});
  is_reflector_ = root.find("reflector") != nullptr && deck.rod_umbrella() == nullptr;
  if (is_reflector_) {
    for (const auto& [name, member] : reflector_groups()) element_groups_.push_back(name);
    if (deck.truss()) n_struts_ = deck.truss()->struts > 0 ? deck.truss()->struts : 3 * deck.truss()->rings;
    if (deck.truss() && !deck.truss()->diagonals) optional_group_ = "diagonals";
  } else if (elements != nullptr && root.at({"model", "mesh"}) == nullptr) {
    element_groups_ = keys(elements);
  } else {
    open_ = true;
  }
  collect();
}

bool Names::defines(const std::string& group) const {
  return std::find(element_groups_.begin(), element_groups_.end(), group) != element_groups_.end();
}

std::optional<Member> Names::required_member(const std::string& group) const {
  const auto found = reflector_groups().find(group);
  if (!is_reflector_ || found == reflector_groups().end()) return {};
  return found->second;
}

std::optional<Member> Names::member(const std::string& group) const {
  const Node* section = root_.at({"groups", group, "section"});
  if (section == nullptr || !section->is_scalar()) return {};
  const Node* kind = root_.at({"sections", section->text, "kind"});
  if (kind == nullptr || section_blocks().find(kind->text) == nullptr) return {};
  static const std::map<std::string, Member> others{
      {"cable", Member::cable},       {"bar", Member::bar},         {"catenary", Member::catenary},
      {"membrane", Member::membrane}, {"shell", Member::shell},     {"spring", Member::spring},
      {"mass", Member::mass},         {"rigid_link", Member::link}, {"hinge", Member::link}};
  const auto found = others.find(kind->text);
  return found == others.end() ? Member::beam : found->second;
}

void Names::collect() {
  known_["material"] = keys(root_.find("materials"));
  known_["section"] = keys(root_.find("sections"));
  known_["node"] = keys(root_.at({"model", "nodes"}));
  auto& regions = known_["group"] = element_groups_;
  if (is_reflector_)
    regions.insert(regions.end(), reflector_selections().begin(), reflector_selections().end());
  for (const auto& name : keys(root_.find("groups"))) {
    const auto what = member(name);
    if (what == Member::cable) known_["cable group"].push_back(name);
    if (what && (is_line_with_state(*what) || what == Member::beam)) known_["line group"].push_back(name);
    if (root_.at({"groups", name, "section"}) == nullptr && !defines(name)) regions.push_back(name);
  }
  if (const Node* loads = root_.find("loads"))
    for (const auto& load : loads->items)
      if (const Node* name = load.find("name")) known_["load"].push_back(name->text);
  for (const char* kind : {"cable group", "line group", "load"}) known_[kind];
  for (const auto& [kind, names] : known_) lookup_[kind].insert(names.begin(), names.end());
}

bool Names::contains(const std::string& kind, const std::string& name) const {
  const auto found = lookup_.find(kind);
  return found != lookup_.end() && found->second.count(name) > 0;
}

std::string Names::home(const std::string& kind) const {
  static const std::map<std::string, std::vector<std::string>> paths{
      {"material", {"materials"}}, {"section", {"sections"}},  {"node", {"model", "nodes"}},
      {"cable group", {"groups"}}, {"line group", {"groups"}}, {"load", {"loads"}}};
  const auto path = paths.find(kind);
  const Node* node = path == paths.end() ? nullptr : root_.at(path->second);
  if (node == nullptr || node->label.line == 0) return {};
  return fmt::format(" ({}, line {})", join(path->second, "."), node->label.line);
}

bool Names::is_known(const std::string& kind, const std::string& name) const {
  if (contains(kind, name)) return true;
  if (kind == "group") return open_ || (strut_number(name) >= 0 && strut_number(name) < n_struts_);
  if (kind == "node")
    return root_.at({"model", "nodes"}) == nullptr;  // a missing block is complained about elsewhere
  if (kind == "material" || kind == "section") {
    const Node* block = root_.find(kind + "s");
    return block != nullptr && !block->is_mapping();
  }
  // A group whose section is faulty is complained about there.
  const bool of_elements = kind == "cable group" || kind == "line group";
  return of_elements && root_.at({"groups", name, "section"}) != nullptr && !member(name);
}

std::string Names::remedy(const std::string& kind, const std::string& name) const {
  if (kind == "group" && is_reflector_ && strut_number(name) >= 0)
    return fmt::format("this reflector has strut_0 to strut_{}", n_struts_ - 1);
  return did_you_mean(name, known(kind));
}

void check_references(const Names& names, Reader& reader) {
  for (const auto& reference : reader.references()) {
    if (names.is_known(reference.kind, reference.name)) continue;
    const auto known = names.known(reference.kind);
    std::string expectation = fmt::format("the deck defines no {}s", reference.kind);
    if (!known.empty())
      expectation = fmt::format("expected one of: {}{}", join(known), names.home(reference.kind));
    std::string suggestion = names.remedy(reference.kind, reference.name);
    if (!reference.note.empty()) suggestion += (suggestion.empty() ? "" : "; ") + reference.note;
    std::string message = fmt::format("unknown {} \"{}\"", reference.kind, reference.name);
    const auto member = names.member(reference.name);
    if (member && (reference.kind == "cable group" || reference.kind == "line group"))
      message = fmt::format("\"{}\" is no {} (it is made of {})", reference.name, reference.kind,
                            to_string(*member));
    reader.complain(reference.place, message, reference.context, expectation, suggestion);
  }
}

}  // namespace tautline::deck
