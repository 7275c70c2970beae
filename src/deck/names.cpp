#include <fmt/format.h>

#include <algorithm>
#include <deck/cross_checks.hpp>
#include <deck/keywords.hpp>
#include <deck/reflector_names.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

using Members = std::map<std::string, Member>;

const Members& truss_groups() {
  static const Members table{{"front_net", Member::cable}, {"rear_net", Member::cable},
                             {"ties", Member::cable},      {"diagonals", Member::cable},
                             {"front_rim", Member::beam},  {"rear_rim", Member::beam},
                             {"struts", Member::beam},     {"cloth", Member::membrane}};
  return table;
}

/// Parts of an umbrella's nets, without front_ or rear_.
const std::vector<const char*>& umbrella_cords() {
  static const std::vector<const char*> list{"net",
                                             "rings",
                                             "columns",
                                             "connectors",
                                             "end_connectors",
                                             "peripheral",
                                             "end_peripheral",
                                             "crossing_a_inner",
                                             "crossing_a_outer",
                                             "crossing_b_inner",
                                             "crossing_b_outer",
                                             "end_cords"};
  return list;
}

const Members& umbrella_groups() {
  static const Members table = [] {
    Members members{{"ties", Member::cable},       {"fork_cords", Member::cable},
                    {"apex_cords", Member::cable}, {"joint_cords", Member::cable},
                    {"root_links", Member::beam},  {"intermediate_links", Member::beam},
                    {"front_links", Member::beam}, {"rear_links", Member::beam},
                    {"cloth", Member::membrane},   {"hub", Member::mass}};
    for (const std::string net : {"front_", "rear_"})
      for (const char* part : umbrella_cords()) members[net + part] = Member::cable;
    return members;
  }();
  return table;
}

/// What a name may have to stand for, of groups with a section.
const std::vector<std::string>& element_group_kinds() {
  static const std::vector<std::string> list{"cable group", "cable or bar group", "line group",
                                             "membrane group", "beam group"};
  return list;
}

bool is_element_group(const std::string& kind) {
  const auto& kinds = element_group_kinds();
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
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
  umbrella_ = deck.rod_umbrella();
  if (umbrella_ != nullptr) {
    for (int k = 1; k <= umbrella_->links; ++k)
      for (const char* kind : {"link", "parallel"}) element_groups_.push_back(fmt::format("{}_{}", kind, k));
  } else if (is_reflector_) {
    describe_reflector(deck);
  } else if (elements != nullptr && root.at({"model", "mesh"}) == nullptr) {
    element_groups_ = keys(elements);
  } else {
    open_ = true;
  }
  collect();
}

void Names::describe_reflector(const Deck& deck) {
  if (const auto names = names_of_reflector(deck)) {
    reflector_groups_ = names->groups;
    optional_groups_ = names->optional_groups;
    selections_ = names->selections;
    numbered_ = names->numbered;
    n_numbered_ = names->n_numbered;
    for (const auto& [name, member] : reflector_groups_) element_groups_.push_back(name);
    return;
  }
  reflector_groups_ = deck.umbrella() ? umbrella_groups() : truss_groups();
  for (const auto& [name, member] : reflector_groups_) element_groups_.push_back(name);
  if (const auto* umbrella = deck.umbrella()) {
    selections_ = {"hub_nodes", "tips", "front_net_nodes", "rear_net_nodes"};
    numbered_ = "spoke_";
    n_numbered_ = umbrella->spokes;
    for (const char* part : umbrella_cords()) {
      const auto front = umbrella->front_pattern, rear = umbrella->rear_pattern.value_or(front);
      if (!reflector::has_cords(*umbrella, front, part))
        optional_groups_.insert(fmt::format("front_{}", part));
      if (!reflector::has_cords(*umbrella, rear, part)) optional_groups_.insert(fmt::format("rear_{}", part));
    }
    return;
  }
  selections_ = {"held_strut", "front_net_nodes", "rear_net_nodes", "front_rim_nodes", "rear_rim_nodes"};
  numbered_ = "strut_";
  if (const auto* truss = deck.truss()) {
    n_numbered_ = truss->struts > 0 ? truss->struts : 3 * truss->rings;
    if (!truss->diagonals) optional_groups_ = {"diagonals"};
  }
}

int Names::number_of(const std::string& name) const {
  return is_reflector_ && name.rfind(numbered_, 0) == 0 ? list_index(name.substr(numbered_.size())) : -1;
}

bool Names::defines(const std::string& group) const {
  return std::find(element_groups_.begin(), element_groups_.end(), group) != element_groups_.end();
}

std::optional<Member> Names::required_member(const std::string& group) const {
  const auto found = reflector_groups_.find(group);
  if (found == reflector_groups_.end()) return {};
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
  regions.insert(regions.end(), selections_.begin(), selections_.end());
  if (umbrella_ != nullptr) {
    for (const char* name : {"roots", "tips"}) regions.emplace_back(name);
    for (int rod = 0; rod < umbrella_->rods; ++rod) regions.push_back(fmt::format("rod_{}", rod));
    for (const auto& name : element_groups_) {
      known_["line group"].push_back(name);
      if (name[0] == 'p') known_["cable group"].push_back(name);
    }
    known_["load"].emplace_back("turn");
  }
  for (const auto& name : keys(root_.find("groups"))) {
    const auto what = member(name);
    if (what == Member::cable) known_["cable group"].push_back(name);
    if (what == Member::cable || what == Member::bar) known_["cable or bar group"].push_back(name);
    if (what == Member::beam) known_["beam group"].push_back(name);
    if (what == Member::membrane) known_["membrane group"].push_back(name);
    if (what && (is_line_with_state(*what) || what == Member::beam)) known_["line group"].push_back(name);
    if (root_.at({"groups", name, "section"}) == nullptr && !defines(name)) regions.push_back(name);
  }
  if (const Node* loads = root_.find("loads"))
    for (const auto& load : loads->items)
      if (const Node* name = load.find("name")) known_["load"].push_back(name->text);
  for (const auto& kind : element_group_kinds()) known_[kind];
  known_["load"];
  for (const auto& [kind, names] : known_) lookup_[kind].insert(names.begin(), names.end());
}

bool Names::contains(const std::string& kind, const std::string& name) const {
  const auto found = lookup_.find(kind);
  return found != lookup_.end() && found->second.count(name) > 0;
}

std::string Names::home(const std::string& kind) const {
  static const std::map<std::string, std::vector<std::string>> paths{{"material", {"materials"}},
                                                                     {"section", {"sections"}},
                                                                     {"node", {"model", "nodes"}},
                                                                     {"groups", {"groups"}},
                                                                     {"load", {"loads"}}};
  const auto path = paths.find(is_element_group(kind) ? "groups" : kind);
  const Node* node = path == paths.end() ? nullptr : root_.at(path->second);
  if (node == nullptr || node->label.line == 0) return {};
  return fmt::format(" ({}, line {})", join(path->second, "."), node->label.line);
}

bool Names::is_known(const std::string& kind, const std::string& name) const {
  if (contains(kind, name)) return true;
  if (kind == "group") return open_ || (number_of(name) >= 0 && number_of(name) < n_numbered_);
  if (kind == "node")
    return root_.at({"model", "nodes"}) == nullptr;  // a missing block is complained about elsewhere
  if (kind == "material" || kind == "section") {
    const Node* block = root_.find(kind + "s");
    return block != nullptr && !block->is_mapping();
  }
  // A group whose section is faulty is complained about there.
  return is_element_group(kind) && root_.at({"groups", name, "section"}) != nullptr && !member(name);
}

std::string Names::remedy(const std::string& kind, const std::string& name) const {
  if (kind == "group" && number_of(name) >= 0)
    return fmt::format("this reflector has {0}0 to {0}{1}", numbered_, n_numbered_ - 1);
  return did_you_mean(name, known(kind));
}

void check_references(const Names& names, Reader& reader) {
  constexpr int most_remedies =
      200;  // of all that are shown; to look for more takes long in a deck of many names
  int n_unknown = 0;
  for (const auto& reference : reader.references()) {
    if (names.is_known(reference.kind, reference.name)) continue;
    const auto& known = names.known(reference.kind);
    std::string expectation = fmt::format("the deck defines no {}s", reference.kind);
    if (!known.empty())
      expectation = fmt::format("expected one of: {}{}", join(known), names.home(reference.kind));
    std::string suggestion =
        ++n_unknown <= most_remedies ? names.remedy(reference.kind, reference.name) : std::string();
    if (!reference.note.empty()) suggestion += (suggestion.empty() ? "" : "; ") + reference.note;
    std::string message = fmt::format("unknown {} \"{}\"", reference.kind, reference.name);
    const auto member = names.member(reference.name);
    if (member && is_element_group(reference.kind))
      message = fmt::format("\"{}\" is no {} (it is made of {})", reference.name, reference.kind,
                            to_string(*member));
    reader.complain(reference.place, message, reference.context, expectation, suggestion);
  }
}

}  // namespace tautline::deck
