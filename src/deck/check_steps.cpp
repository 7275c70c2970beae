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
      if (!fits_structure(step, *node)) continue;
      if (const auto* options = std::get_if<RodShapingOptions>(&step.options))
        check_rod_shaping(*options, *node);
      if (const auto* options = std::get_if<FormFindingOptions>(&step.options))
        check_form_finding(*options, *node);
      if (std::holds_alternative<TuningStepOptions>(step.options)) check_tuning(*node);
      if (std::holds_alternative<InverseOptions>(step.options)) check_inverse(*node);
      if (const auto* options = std::get_if<CollapseOptions>(&step.options)) check_collapse(*options, *node);
      if (const auto* options = std::get_if<EquilibriumOptions>(&step.options)) {
        has_equilibrium_ = true;
        acting_ = options->loads ? *options->loads : names_.known("load");
      }
      if (std::holds_alternative<EquilibriumOptions>(step.options))
        check_unique(node->find("stages"), "stage", {"steps", std::to_string(i), "stages"}, reader_);
    }
  }

 private:
  /// Complains unless the structure is of the kind that the step works on.
  bool fits_structure(const Step& step, const Node& node) {
    const bool of_rods = std::holds_alternative<RodShapingOptions>(step.options);
    const Node* kind = root_.at({"reflector", "kind"});
    const bool unknown = kind != nullptr && reflector_blocks().find(kind->text) == nullptr;
    const Node& place = *node.find("kind");
    if (of_rods) has_rods_ = true;
    if (unknown) return true;
    if (deck_.rod_umbrella() == nullptr) {
      if (of_rods)
        reader_.complain(place.place, "kind rod_shaping needs a reflector of kind rod-umbrella", context_);
      return !of_rods;
    }
    const bool of_nets = std::holds_alternative<FormFindingOptions>(step.options) ||
                         std::holds_alternative<TuningStepOptions>(step.options);
    if (of_nets)
      reader_.complain(place.place, fmt::format("kind {} does not work on a rod-umbrella", step.kind),
                       context_, "expected one of: rod_shaping, mesh, equilibrium, inverse, modal");
    else if (!has_rods_)
      reader_.complain(place.place,
                       fmt::format("kind {} on a rod-umbrella needs a rod_shaping step before it", step.kind),
                       context_, {}, "rod_shaping finds the cables, or takes them as given by `stiffness`");
    const auto& mass = deck_.rod_umbrella()->mass_per_length;
    const bool modal = std::holds_alternative<ModalOptions>(step.options);
    if (modal && std::all_of(mass.begin(), mass.end(), [](double m) { return m == 0; }))
      reader_.complain(place.place, "kind modal needs rods with a mass", context_,
                       "expected reflector.mass_per_length: numbers > 0 [kg/m]");
    return !of_nets && has_rods_;
  }

  void check_rod_shaping(const RodShapingOptions& options, const Node& node) {
    if (deck_.rod_umbrella() == nullptr) return;
    const int links = deck_.rod_umbrella()->links;
    for (const auto& [key, values] :
         {std::pair{"stiffness", &options.stiffness}, std::pair{"reaction", &options.reaction}}) {
      const Node* list = node.find(key);
      if (list == nullptr || !*values) continue;
      if (const auto n = static_cast<int>((*values)->size()); n != 1 && n != links)
        reader_.complain(list->place, fmt::format("{} has {} numbers for {} nodes", key, n, links), context_,
                         fmt::format("expected one number for all, or {}", links));
    }
  }

  void check_form_finding(const FormFindingOptions& options, const Node& node) {
    if (deck_.y_umbrella()) {
      reader_.complain(
          node.label, "form_finding does not know the net of a y-umbrella", context_, {},
          "its beams are part of it: give its cords their tensions and begin with an equilibrium");
      return;
    }
    if (deck_.dish()) check_reflector_form(options, node);
    if (const Node* rear = node.find("rear"); rear != nullptr && deck_.dish() == nullptr)
      reader_.complain(rear->label, "\"rear\" is for reflectors", context_, {}, "a plain model has one net");
    if (options.method != FormMethod::tension) return;
    for (const auto& group : net_of(options)) {
      const Node* block = root_.at({"groups", group});
      if (block == nullptr || names_.member(group) != Member::cable) continue;
      const Node* tension = block->find("tension");
      if (const auto known = deck_.groups.find(group);
          known != deck_.groups.end() && known->second.tension && *known->second.tension == 0)
        reader_.complain(tension->place, fmt::format("tension = 0 asks nothing of net group \"{}\"", group),
                         context_text({"groups", group}), "expected a number > 0 [N]",
                         "a cable without tension is no part of a net: leave the group out of `net`");
      if (tension != nullptr || block->find("force_density") != nullptr) continue;
      reader_.complain(
          block->label, fmt::format("net group \"{}\" has no tension", group),
          context_text({"groups", group}),
          "expected tension: a number > 0 [N], or a force_density to be kept",
          fmt::format(
              "form-finding (line {}) finds the shape for prescribed tensions; method: linear does without",
              node.label.line));
    }
  }

  void check_reflector_form(const FormFindingOptions& options, const Node& node) {
    for (const char* key : {"fixed", "surface", "on_surface", "ties", "guides"})
      if (const Node* value = node.find(key))
        reader_.complain(value->label, fmt::format("\"{}\" is for plain models", key), context_, {},
                         "the net of a reflector is fixed on its rim or spokes and lies on its paraboloid");
    if (options.method != FormMethod::tension && options.method != FormMethod::linear &&
        options.method != FormMethod::balanced && options.method != FormMethod::constraints)
      reader_.complain(*node.find("method"), "this method does not bind a net to a paraboloid",
                       "expected one of: tension, linear, balanced, constraints");
    check_rear(options, node);
  }

  /// A rear net that is found by itself hangs in a rigid frame, and only the same pattern can be mirrored.
  void check_rear(const FormFindingOptions& options, const Node& node) {
    const auto* umbrella = deck_.umbrella();
    const bool differs = umbrella != nullptr &&
                         umbrella->rear_pattern.value_or(umbrella->front_pattern) != umbrella->front_pattern;
    const RearForm rear = options.rear.value_or(differs ? RearForm::balanced : RearForm::mirrored);
    if (differs && rear == RearForm::mirrored)
      reader_.complain(*node.find("rear"), "the rear net has another pattern than the front net", context_,
                       "expected one of: tension, balanced");
    if (rear != RearForm::mirrored && options.frame != FrameKind::rigid)
      reader_.complain(*node.find("frame"), "a rear net found by itself needs a rigid frame", context_,
                       "expected frame: rigid");
  }

  std::vector<std::string> net_of(const FormFindingOptions& options) const {
    if (!options.net.empty()) return options.net;
    if (!deck_.dish()) return names_.known("cable group");
    std::vector<std::string> front;
    for (const auto& name : names_.known("cable group"))
      if (name.rfind("front_", 0) == 0) front.push_back(name);
    return front;
  }

  void check_inverse(const Node& node) {
    if (!has_equilibrium_)
      reader_.complain(node.label, "an inverse step needs an equilibrium step before it", context_, {},
                       "it starts from an equilibrium and keeps the loads that act there");
  }

  /// Safety factors compare nodal forces with compressions: there must be nothing else that grows.
  void check_collapse(const CollapseOptions& options, const Node& node) {
    if (options.working_forces.empty()) return;
    const auto has = [](const std::vector<std::string>& list, const std::string& name) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    for (const auto& load : deck_.loads) {
      const bool grows = options.loads ? has(*options.loads, load.name)
                                       : !has(acting_, load.name) && !has(options.disturbance, load.name);
      const bool other = load.displacement || load.rotation || load.line_force || load.line_moment ||
                         load.surface_force || load.pressure || load.temperature_change ||
                         !load.temperature_field.empty() || load.acceleration;
      if (grows && (other || load.force.isZero(0)))
        reader_.complain(
            node.find("working_forces")->label,
            fmt::format("working_forces are compared with nodal forces, and load \"{}\" that grows "
                        "is none",
                        load.name),
            context_, "expected loads that grow by `force` alone",
            "leave working_forces out: critical_lambda is the factor on these loads");
    }
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
  bool has_rods_ = false;            ///< a rod_shaping step stands before
  bool has_equilibrium_ = false;     ///< an equilibrium step stands before
  std::vector<std::string> acting_;  ///< loads of the equilibrium before
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
