#include "steps/release.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/text.hpp>

namespace tautline::steps {

namespace {

using Names = std::vector<std::string>;

/// Axial stiffness of a beam group, membrane stiffness times the structure's size of a shell group [N].
double stiffness_of(const model::Group& group, double size) {
  if (group.kind == model::ElementKind::beam) return group.beam.axial_stiffness;
  return group.shell.young_modulus * group.shell.thickness * size;
}

/// Groups that can be held, stiffest first.
Names frame_groups(const assembly::System& system) {
  std::vector<std::pair<double, std::string>> list;
  for (const auto& group : system.model().groups)
    if (group.kind == model::ElementKind::beam || group.kind == model::ElementKind::shell)
      list.emplace_back(-stiffness_of(group, system.size()), group.name);
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Names names;
  for (const auto& [stiffness, name] : list) names.push_back(name);
  return names;
}

class Search {
 public:
  Search(Context& context, Names loads) : context_(context), loads_(std::move(loads)) {
    held_ = frame_groups(context.system());
  }

  ReleaseSchedule run() {
    const auto start = context_.system().rest();
    const auto acting = context_.acting_loads;
    if (!release_at_once()) release_in_rounds();
    context_.system().restore(start);
    context_.acting_loads = acting;
    tell();
    return std::move(result_);
  }

 private:
  /// Follows a stage that holds these groups. Where it fails the system goes back to where it was.
  bool attempt(const Names& hold) {
    auto& system = context_.system();
    const auto before = system.rest();
    context_.acting_loads = hold.empty() ? loads_ : Names{};
    const auto start = system.begin_stage(context_.boundary(hold, true));
    auto options = context_.deck.solver;
    options.min_step = std::max(options.min_step, shortest);
    const auto path = follow(context_, fmt::format("release, held [{}]", join(hold)), options, {},
                             {0, context_.is_lost(start), {}, {}});
    result_.attempts.push_back({{"hold", hold},
                                {"reached", path.reached},
                                {"newton_iterations", path.newton_iterations},
                                {"descent_steps", path.descent_steps},
                                {"lambda", path.lambda()}});
    context_.progress.say(fmt::format("{} | release, held [{}]: {}", context_.step_name, join(hold),
                                      path.reached ? "reached" : "failed"));
    if (!path.reached) {
      system.restore(before);
      return false;
    }
    StageOptions stage;
    stage.hold = hold;
    stage.name = hold.empty() ? "supports only" : fmt::format("{} held", join(hold));
    result_.stages.push_back(stage);
    return true;
  }

  bool release_at_once() { return attempt({}) || held_.empty(); }

  /// First all of the frame is held; then, round after round, the largest set is released that can be.
  void release_in_rounds() {
    if (!attempt(held_)) return;
    while (!held_.empty()) {
      bool moved = false;
      for (std::size_t n = held_.size(); n > 0 && !moved; --n) {
        const Names rest(held_.begin() + static_cast<long>(n), held_.end());
        moved = attempt(rest);
        if (moved) held_ = rest;
      }
      if (!moved) return;
    }
  }

  void tell() {
    if (result_.stages.empty() || !result_.stages.back().hold.empty()) {
      StageOptions last;
      last.name = "supports only";
      result_.stages.push_back(last);
      result_.summary = "no schedule was found; the last stage is tried with the smallest steps";
    } else {
      result_.summary = fmt::format("{} stage{} after {} attempts", result_.stages.size(),
                                    result_.stages.size() == 1 ? "" : "s", result_.attempts.size());
    }
    result_.schedule = "stages:\n";
    for (const auto& stage : result_.stages)
      result_.schedule += stage.hold.empty() ? fmt::format("  - {{name: {}}}\n", stage.name)
                                             : fmt::format("  - {{name: \"{}\", hold: [{}]}}\n", stage.name,
                                                           join(stage.hold, ", ", stage.hold.size()));
  }

  static constexpr double shortest = 1.0 / 64;  // a release that needs shorter steps counts as failed
  Context& context_;
  Names loads_, held_;
  ReleaseSchedule result_;
};

}  // namespace

ReleaseSchedule find_release(Context& context, const std::vector<std::string>& loads) {
  return Search(context, loads).run();
}

}  // namespace tautline::steps
