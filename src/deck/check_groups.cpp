#include <fmt/format.h>

#include <algorithm>
#include <deck/cross_checks.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

using steps::FormFindingOptions;

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

class GroupCheck {
 public:
  GroupCheck(const Deck& deck, const Names& names, const Node& root, Reader& reader)
      : deck_(deck), names_(names), root_(root), reader_(reader) {}

  void run() {
    const Node* groups = root_.find("groups");
    if (groups == nullptr || !groups->is_mapping()) return;
    for (const auto& entry : groups->entries) {
      if (entry.value.find("section") == nullptr) {
        check_node_set(entry);
        continue;
      }
      check_defined(entry);
      check_member(entry);
      check_state(entry);
    }
    check_unbound(*groups);
    check_materials();
  }

 private:
  std::string context(const std::string& group) const { return context_text({"groups", group}); }

  void check_defined(const Entry& entry) {
    if (names_.open() || names_.defines(entry.key)) return;
    const bool reflector = deck_.dish() != nullptr;
    reader_.complain(
        entry.place, fmt::format("no elements belong to group \"{}\"", entry.key), "in groups",
        fmt::format("groups of the {}: {}", reflector ? "reflector" : "model", join(names_.element_groups())),
        did_you_mean(entry.key, names_.element_groups()));
  }

  void check_node_set(const Entry& entry) {
    const Node* nodes = entry.value.find(entry.value.find("nodes") != nullptr ? "nodes" : "edges");
    if (nodes == nullptr) return;
    if (names_.defines(entry.key))
      reader_.complain(entry.place,
                       fmt::format("\"{}\" is a group of elements, not a set of nodes", entry.key),
                       "in groups", "expected \"section\"");
    if (root_.find("reflector") != nullptr || root_.at({"model", "mesh"}) != nullptr)
      reader_.complain(
          nodes->label,
          fmt::format("\"{}\" needs nodes with names",
                      entry.value.find("nodes") != nullptr ? "nodes" : "edges"),
          context(entry.key),
          "expected a model with inline nodes; a reflector and a mesh file bring their own groups");
  }

  /// The section fits what the group is made of, the other keys fit the section.
  void check_member(const Entry& entry) {
    const auto member = names_.member(entry.key);
    if (!member) return;
    const auto needed = names_.required_member(entry.key);
    if (needed && *needed != *member) {
      const Node& section = *entry.value.find("section");
      reader_.complain(section.place,
                       fmt::format("section \"{}\" is for {}, but group \"{}\" is made of {}", section.text,
                                   to_string(*member), entry.key, to_string(*needed)),
                       context(entry.key));
    }
    for (const auto& [key, place, value] : entry.value.entries) {
      const auto homes = homes_of_key(key);
      if (homes.empty() || std::find(homes.begin(), homes.end(), *member) != homes.end()) continue;
      reader_.complain(place,
                       fmt::format("\"{}\" is for {}, but group \"{}\" is made of {}", key,
                                   to_string(homes.front()), entry.key, to_string(*member)),
                       context(entry.key));
    }
  }

  /// What a key of a group is for; nothing where it is for every group.
  static std::vector<Member> homes_of_key(const std::string& key) {
    if (key == "prestress" || key == "initial_stress") return {Member::membrane, Member::shell};
    if (key == "orientation") return {Member::beam, Member::membrane, Member::shell};
    if (key.rfind("release_", 0) == 0 || key.rfind("offset_", 0) == 0) return {Member::beam};
    if (key == "tension" || key == "force_density") return {Member::cable, Member::bar};
    if (contains(initial_states(), key)) return {Member::cable, Member::bar, Member::catenary};
    return {};
  }

  /// Only a bar is pressed.
  void check_sign(const Entry& entry) {
    const auto group = deck_.groups.find(entry.key);
    if (group == deck_.groups.end()) return;
    const auto& options = group->second;
    const auto complain = [&](const char* key, const char* expectation) {
      const Node& value = *entry.value.find(key);
      reader_.complain(value.place, fmt::format("{} = {} would press a cable", key, value.text),
                       context(entry.key), expectation,
                       "members in compression are of a section of kind bar");
    };
    if (options.tension && *options.tension < 0) complain("tension", "expected a number >= 0 [N]");
    if (options.force_density && *options.force_density <= 0)
      complain("force_density", "expected a number > 0 [N/m]");
  }

  static const std::string* state_of(const Node& group) {
    for (const auto& entry : group.entries)
      if (contains(initial_states(), entry.key)) return &entry.key;
    return nullptr;
  }

  /// A cable group has one initial state, unless form-finding supplies it.
  void check_state(const Entry& entry) {
    const auto member = names_.member(entry.key);
    if (member != Member::cable && member != Member::catenary) return;
    const std::string* state = state_of(entry.value);
    if (member == Member::catenary) {
      if (state == nullptr)
        reader_.complain(entry.place, fmt::format("catenary group \"{}\" has no length", entry.key),
                         "in groups", "expected exactly one of: unstressed_length, prestrain");
      return;
    }
    check_sign(entry);
    const bool supplied = is_supplied(entry.key);
    if (state == nullptr && !supplied)
      reader_.complain(entry.place, fmt::format("cable group \"{}\" has no initial state", entry.key),
                       "in groups", "expected exactly one of: " + join(initial_states()), remedy(entry.key));
    if (state != nullptr && supplied && deck_.dish())
      reader_.complain(entry.value.find(*state)->label,
                       fmt::format("the tension of \"{}\" follows from form_finding", entry.key),
                       context(entry.key), {}, fmt::format("leave \"{}\" out", *state));
  }

  std::string remedy(const std::string& group) const {
    if (deck_.dish() && group == "ties") return "a form_finding step would find the tension of \"ties\"";
    if (deck_.model) return "a form_finding step with method linear would supply it to its net";
    return {};
  }

  bool is_supplied(const std::string& group) const {
    return std::any_of(deck_.steps.begin(), deck_.steps.end(), [&](const steps::Step& step) {
      const auto* form_finding = std::get_if<FormFindingOptions>(&step.options);
      if (form_finding == nullptr || step.kind.empty()) return false;
      if (deck_.dish()) return group == "ties" && deck_.y_umbrella() == nullptr;
      const bool in_net = form_finding->net.empty() || contains(form_finding->net, group);
      using enum steps::FormMethod;
      const bool finds_densities = form_finding->method == linear || form_finding->method == constraints ||
                                   form_finding->method == film || form_finding->method == self_stress;
      return (finds_densities && in_net) || contains(form_finding->ties, group);
    });
  }

  /// Every element group has an entry in `groups`.
  void check_unbound(const Node& groups) {
    std::vector<std::string> missing;
    for (const auto& name : names_.element_groups())
      if (groups.find(name) == nullptr && names_.needs_section(name)) missing.push_back(name);
    if (missing.empty()) return;
    reader_.complain(groups.label,
                     fmt::format("no section is given for group{} \"{}\"", missing.size() > 1 ? "s" : "",
                                 join(missing, "\", \"")),
                     "in groups", fmt::format("expected an entry \"{}: {{section: ...}}\"", missing.front()));
  }

  /// Beams and membranes need Poisson's ratio of their material.
  void check_materials() {
    const Node* sections = root_.find("sections");
    if (sections == nullptr) return;
    for (const auto& [name, place, section] : sections->entries) {
      const Node* kind = section.find("kind");
      const Node* material = section.find("material");
      const bool needs_no_ratio =
          kind != nullptr && (kind->text == "cable" || kind->text == "bar" || kind->text == "catenary");
      if (kind == nullptr || material == nullptr || needs_no_ratio ||
          section_blocks().find(kind->text) == nullptr)
        continue;
      const Node* block = root_.at({"materials", material->text});
      if (block == nullptr || !block->is_mapping() || block->find("poisson_ratio") != nullptr) continue;
      reader_.complain(block->label, "missing key \"poisson_ratio\"",
                       context_text({"materials", material->text}), "expected a number in (-1, 0.5]",
                       fmt::format("section \"{}\" (kind {}) needs it", name, kind->text));
    }
  }

  const Deck& deck_;
  const Names& names_;
  const Node& root_;
  Reader& reader_;
};

}  // namespace

void check_groups(const Deck& deck, const Names& names, const Node& root, Reader& reader) {
  GroupCheck(deck, names, root, reader).run();
}

}  // namespace tautline::deck
