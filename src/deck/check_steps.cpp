#include <fmt/format.h>

#include <algorithm>
#include <deck/cross_checks.hpp>
#include <deck/keywords.hpp>
#include <filesystem>
#include <set>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

using namespace steps;

/// Names given twice in a list of blocks.
void check_unique(const Node* list, const std::string& what, const std::vector<std::string>& path,
                  Reader& reader) {
  if (list == nullptr) return;
  std::map<std::string, int> seen;
  for (const auto& item : list->items) {
    const Node* name = item.find("name");
    if (name == nullptr || !name->is_scalar()) continue;
    const auto [first, is_new] = seen.emplace(name->text, name->place.line);
    if (!is_new)
      reader.complain(name->place, fmt::format("two {}s are called \"{}\"", what, name->text),
                      context_text(path), {}, fmt::format("the first stands in line {}", first->second));
  }
}

void fill_names(std::vector<Step>& steps) {
  std::map<std::string, int> total, number;
  std::set<std::string> taken;
  for (const auto& step : steps) {
    ++total[step.kind];
    taken.insert(step.name);
  }
  for (auto& step : steps) {
    const int k = ++number[step.kind];
    if (!step.name.empty()) continue;
    step.name = total[step.kind] > 1 ? fmt::format("{} {}", step.kind, k) : step.kind;
    while (!taken.insert(step.name).second) step.name += "'";
  }
}

class StepCheck {
 public:
  StepCheck(const Deck& deck, const Names& names, const Node& root, Reader& reader)
      : deck_(deck), names_(names), root_(root), reader_(reader) {}

  void run() {
    for (std::size_t i = 0; i < deck_.steps.size(); ++i) {
      const Node* node = root_.at({"steps", std::to_string(i)});
      const Step& step = deck_.steps[i];
      if (node == nullptr || step.kind.empty()) continue;
      context_ = fmt::format("in steps.{} (\"{}\")", i, label_of(*node));
      if (const auto* options = std::get_if<FormFindingOptions>(&step.options))
        check_form_finding(*options, *node);
      if (std::holds_alternative<TuningStepOptions>(step.options)) check_tuning(*node);
      if (std::holds_alternative<EquilibriumOptions>(step.options))
        check_unique(node->find("stages"), "stage", {"steps", std::to_string(i), "stages"}, reader_);
    }
  }

 private:
  void check_form_finding(const FormFindingOptions& options, const Node& node) {
    if (deck_.reflector && node.find("fixed") != nullptr)
      reader_.complain(node.find("fixed")->label, "\"fixed\" is for plain models", context_, {},
                       "the net of a reflector is fixed on its rim");
    if (options.method != FormFindingOptions::Method::tension) return;
    for (const auto& group : net_of(options)) {
      const Node* block = root_.at({"groups", group});
      if (block == nullptr || names_.member(group) != Member::cable || block->find("tension") != nullptr)
        continue;
      reader_.complain(
          block->label, fmt::format("net group \"{}\" has no tension", group),
          context_text({"groups", group}), "expected tension: a number >= 0 [N]",
          fmt::format(
              "form-finding (line {}) finds the shape for prescribed tensions; method: linear does without",
              node.label.line));
    }
  }

  std::vector<std::string> net_of(const FormFindingOptions& options) const {
    if (!options.net.empty()) return options.net;
    return deck_.reflector ? std::vector<std::string>{"front_net"} : names_.known("cable group");
  }

  void check_tuning(const Node& node) {
    if (root_.find("reflector") == nullptr)
      reader_.complain(node.label, "a tuning step needs a reflector", context_, {},
                       "only a reflector has a surface to be tuned");
  }

  const Deck& deck_;
  const Names& names_;
  const Node& root_;
  Reader& reader_;
  std::string context_;
};

}  // namespace

void check_steps(Deck& deck, const Names& names, const Node& root, Reader& reader) {
  if (const Node* list = root.find("steps"); list != nullptr && list->is_sequence() && list->items.empty())
    reader.complain(list->label, "\"steps\" is an empty list", context_text({}),
                    "expected at least one step");
  check_unique(root.find("steps"), "step", {"steps"}, reader);
  check_unique(root.find("loads"), "load", {"loads"}, reader);
  check_unique(root.find("supports"), "support", {"supports"}, reader);
  StepCheck(deck, names, root, reader).run();
  fill_names(deck.steps);
}

}  // namespace tautline::deck
