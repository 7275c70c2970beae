#include "steps/diagnosis.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/model/doubts.hpp>
#include <tautline/model/names.hpp>

namespace tautline::steps {

namespace {

constexpr double lost_below = 0.1, mostly_lost_below = 0.5;  // of the mean tension at the beginning
constexpr double large_strain = 0.05;                        // of members
constexpr std::size_t most_groups = 4;

/// Tensions of one group, of cables [N] or of membranes, the smaller principal one [N/m].
struct Tension {
  double sum = 0;
  int count = 0, slack = 0;
  double mean() const { return count > 0 ? sum / count : 0; }
};

std::vector<Tension> tensions(const model::Model& model, const model::Response& response) {
  std::vector<Tension> groups(model.groups.size());
  const auto add = [&](int group, double value, bool slack) {
    auto& tension = groups[static_cast<std::size_t>(group)];
    tension.sum += value;
    tension.slack += slack ? 1 : 0;
    ++tension.count;
  };
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    add(model.cables[i].group, response.cables[i].tension, response.cables[i].slack);
  for (std::size_t i = 0; i < model.membranes.size(); ++i)
    add(model.membranes[i].group, response.membranes[i].principal_cauchy[1],
        response.membranes[i].state != element::MembraneState::taut);
  return groups;
}

std::string figure(double value) {
  return std::abs(value) >= 1e3 && std::abs(value) < 1e7 ? fmt::format("{:.0f}", value)
                                                         : fmt::format("{:.3g}", value);
}

const char* unit_of(const model::Group& group) {
  return group.kind == model::ElementKind::membrane ? "N/m" : "N";
}

class Examination {
 public:
  Examination(Context& context, const Beginning& beginning, const Ending& ending)
      : model_(context.system().model()),
        beginning_(beginning),
        ending_(ending),
        state_(context.system().state()),
        response_(model::evaluate_response(model_, state_)) {}

  Diagnosis run() {
    find_lost_prestress();
    find_pressed();
    find_strained();
    tell_load_factor();
    find_moved();
    result_.remedy = remedy();
    return std::move(result_);
  }

 private:
  void find_lost_prestress() {
    const auto before = tensions(model_, beginning_.response), now = tensions(model_, response_);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t g = 0; g < now.size(); ++g) {
      if (!(before[g].mean() > 0)) continue;
      const double left = now[g].mean() / before[g].mean();
      if (left < mostly_lost_below || now[g].slack > before[g].slack) order.emplace_back(left, g);
    }
    std::sort(order.begin(), order.end());
    if (order.size() > most_groups) order.resize(most_groups);
    for (const auto& [left, g] : order) {
      const auto& group = model_.groups[g];
      const std::string slack =
          now[g].slack > 0 ? fmt::format("; {} of {} slack", now[g].slack, now[g].count) : "";
      result_.findings.push_back(fmt::format("\"{}\" lost {}: {} of {} {} left{}", group.name,
                                             left < lost_below          ? "its prestress"
                                             : left < mostly_lost_below ? "most of its prestress"
                                                                        : "prestress in parts",
                                             figure(std::max(0.0, now[g].mean())), figure(before[g].mean()),
                                             unit_of(group), slack));
      slack_.push_back(fmt::format("\"{}\"", group.name));
    }
  }

  /// The worst of the beams of a group, for `value_of(beam)` beyond `limit`.
  template <class Tell>
  void find_beams(const std::vector<double>& values, double limit, std::vector<std::string>& names,
                  const Tell& tell) {
    for (std::size_t g = 0; g < model_.groups.size(); ++g) {
      std::size_t count = 0, worst = 0;
      for (std::size_t i = 0; i < model_.beams.size(); ++i) {
        if (model_.beams[i].group != static_cast<int>(g) || !(values[i] > limit)) continue;
        if (count++ == 0 || values[i] > values[worst]) worst = i;
      }
      if (count == 0 || names.size() >= most_groups) continue;
      names.push_back(fmt::format("\"{}\"", model_.groups[g].name));
      result_.findings.push_back(tell(worst, count));
    }
  }

  void find_pressed() {
    const auto ratios = model::euler_ratios(model_, response_);
    find_beams(ratios, 1, pressed_, [&](std::size_t worst, std::size_t count) {
      return fmt::format("{} carries {:.3g} times the Euler load of its own length{}",
                         model::beam_name(model_, worst), ratios[worst], among(count));
    });
  }

  void find_strained() {
    const auto strains = model::line_strains(model_, response_);
    find_beams(strains.beams, large_strain, strained_, [&](std::size_t worst, std::size_t count) {
      return fmt::format("{} is strained by {:.3g} %{}", model::beam_name(model_, worst),
                         100 * strains.beams[worst], among(count));
    });
    std::vector<double> largest(model_.groups.size(), 0);
    std::vector<std::size_t> worst(model_.groups.size(), 0);
    for (std::size_t i = 0; i < model_.cables.size(); ++i) {
      const auto g = static_cast<std::size_t>(model_.cables[i].group);
      if (strains.cables[i] <= std::max(large_strain, largest[g])) continue;
      largest[g] = strains.cables[i];
      worst[g] = i;
    }
    for (std::size_t g = 0; g < largest.size() && strained_.size() < most_groups; ++g) {
      if (largest[g] == 0) continue;
      strained_.push_back(fmt::format("\"{}\"", model_.groups[g].name));
      result_.findings.push_back(
          fmt::format("{} is strained by {:.3g} %", model::cable_name(model_, worst[g]), 100 * largest[g]));
    }
  }

  static std::string among(std::size_t count) {
    return count > 1 ? fmt::format(" (the worst of {})", count) : "";
  }

  void tell_load_factor() {
    if (ending_.unstable) return;
    if (ending_.found)
      result_.findings.push_back(
          fmt::format("the last equilibrium found has the load factor {:.4g}", ending_.lambda));
    else
      result_.findings.push_back(
          "no equilibrium was found, not even under a part of the load" +
          (ending_.worst_node < 0 || ending_.out_of_balance == 0
               ? std::string()
               : fmt::format("; at the start {:.3g} N are out of balance at {}", ending_.out_of_balance,
                             model::node_in_group(model_, ending_.worst_node))));
  }

  void find_moved() {
    int most = -1;
    double largest = 0;
    for (std::size_t i = 0; i < state_.displacement.size(); ++i) {
      const double way = (state_.displacement[i] - beginning_.state.displacement[i]).norm();
      if (way <= largest * (1 + 1e-9)) continue;
      largest = way;
      most = static_cast<int>(i);
    }
    if (most >= 0)
      result_.findings.push_back(
          fmt::format("{} moved most, by {:.3g} m", model::node_in_group(model_, most), largest));
  }

  std::string remedy() const {
    if (!slack_.empty())
      return fmt::format(
          "Give {} more prestress, or take less load; where the structure is meant to stand with slack "
          "members, "
          "fallback: descent looks for that state",
          join(slack_, " and "));
    if (!pressed_.empty())
      return fmt::format("Take a stiffer section or shorter members for {}, or less load",
                         join(pressed_, " and "));
    if (!strained_.empty())
      return fmt::format("Compare the loads with the stiffness of {}, and their units",
                         join(strained_, " and "));
    if (ending_.unstable)
      return ending_.bifurcated
                 ? "Take the branch of the bifurcation that critical_points tells of (control: arc_length, "
                   "branch: 1), or disturb the structure with a small load"
                 : "Disturb the structure with a small load, or try increments; allow_unstable: true takes "
                   "the "
                   "state as it is";
    if (ending_.found)
      return "If the load has passed a limit, control: arc_length goes round it; the state before it is in "
             "the "
             "results";
    return "Begin nearer to equilibrium: with a form_finding step, a tension or prestress, or a stage that "
           "holds "
           "more (release: automatic)";
  }

  const model::Model& model_;
  const Beginning& beginning_;
  const Ending& ending_;
  const model::State& state_;
  model::Response response_;
  Diagnosis result_;
  std::vector<std::string> slack_, pressed_, strained_;  ///< names of groups
};

}  // namespace

Beginning Beginning::of(const assembly::System& system) {
  return {system.state(), model::evaluate_response(system.model(), system.state())};
}

std::string Diagnosis::text() const {
  return join(findings, "; ") + ". " + remedy;
}

Json Diagnosis::json() const {
  return {{"findings", findings}, {"remedy", remedy}};
}

Diagnosis diagnose(Context& context, const Beginning& beginning, const Ending& ending) {
  return Examination(context, beginning, ending).run();
}

}  // namespace tautline::steps
