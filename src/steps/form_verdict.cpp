#include "steps/form_verdict.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace tautline::steps {

namespace {

/// A branch or node of the net by the deck's names.
std::string place_of(const Context& context, const FormNet& form, const formfinding::Deviation& deviation) {
  return deviation.kind >= formfinding::ConstraintKind::reaction_x
             ? form.node_name(context, deviation.member)
             : form.describe(context.structure, deviation.member);
}

Json worst_json(const Context& context, const FormNet& form, const formfinding::ConstrainedResult& found) {
  Json list = Json::array();
  for (const auto& worst : found.worst)
    list.push_back({{"constraint", worst.constraint},
                    {"kind", formfinding::to_string(worst.kind)},
                    {"where", place_of(context, form, worst)},
                    {"wanted", worst.wanted},
                    {"found", worst.found}});
  return list;
}

Json by_constraint(const Context& context, const FormNet& form, const formfinding::ConstrainedResult& found) {
  Json list = Json::array();
  for (const auto& miss : found.misses)
    list.push_back({{"constraint", miss.constraint},
                    {"kind", formfinding::to_string(miss.kind)},
                    {"members", miss.members},
                    {"missed", miss.missed},
                    {"relative_rms", miss.rms},
                    {"wanted", miss.worst.wanted},
                    {"found", miss.worst.found},
                    {"where", place_of(context, form, miss.worst)}});
  return list;
}

}  // namespace

double rounding_of(const Form& found) {
  constexpr double rounding = 1e-9;
  return found.tension.size() > 0 ? rounding * found.tension.cwiseAbs().maxCoeff() : 0;
}

std::string reason_of_misses(const Context& context, const FormNet& form,
                             const formfinding::ConstrainedResult& found) {
  constexpr std::size_t most_named = 4;
  std::string text =
      found.least_squares_optimum
          ? "no net near the drawn one meets all demands; this is the net with the least weighted squares of "
            "what it misses:"
          : fmt::format("after {} iterations the demands are still missed:", found.iterations);
  for (std::size_t i = 0; i < std::min(most_named, found.misses.size()); ++i) {
    const auto& miss = found.misses[i];
    text += fmt::format("{} {} of {}, {} of {} by {:.2g} % rms, most {}: {}", i > 0 ? ";" : "",
                        formfinding::to_string(miss.kind), miss.constraint, miss.missed, miss.members,
                        100 * miss.rms, place_of(context, form, miss.worst),
                        formfinding::wanted_and_found(miss.worst));
  }
  if (found.misses.size() > most_named)
    text += fmt::format("; and {} more", found.misses.size() - most_named);
  if (const auto& path = found.short_path)
    text += "; " + formfinding::to_string(*path, form.node_name(context, path->from),
                                          form.node_name(context, path->to));
  return text;
}

Json misses_json(const Context& context, const FormNet& form, const formfinding::ConstrainedResult& found) {
  return {{"least_squares_optimum", found.least_squares_optimum},
          {"weighted_squares", found.weighted_squares},
          {"misses", by_constraint(context, form, found)},
          {"worst", worst_json(context, form, found)}};
}

void refuse_pushed_cables(const model::Model& structure, const FormNet& net, Form& found) {
  constexpr std::size_t most_named = 5;
  if (!found.converged) return;
  std::vector<int> pushed;
  for (int b = 0; b < static_cast<int>(found.tension.size()); ++b) {
    if (!net.is_bar(structure, b) && found.tension[b] < -100 * rounding_of(found)) pushed.push_back(b);
  }
  if (pushed.empty()) return;
  std::sort(pushed.begin(), pushed.end(), [&](int a, int b) { return found.tension[a] < found.tension[b]; });
  std::string names;
  for (std::size_t i = 0; i < std::min(most_named, pushed.size()); ++i)
    names += fmt::format("{}{} with {:.4g} N", i > 0 ? "; " : "", net.describe(structure, pushed[i]),
                         -found.tension[pushed[i]]);
  if (pushed.size() > most_named) names += "; ...";
  found.converged = false;
  found.reason = fmt::format(
      "{} of the {} cables would have to push, which no cable can: {}. Ask for other tensions, give "
      "`bounds`, or make them bars",
      pushed.size(), found.tension.size(), names);
}

void refuse_collapsed(const model::Model& structure, const FormNet& net, Form& found) {
  constexpr double nothing = 1e-6;  // of the length as drawn
  if (!found.converged && !found.compromise) return;
  const auto length = [&](const Points& nodes, std::size_t b) {
    const auto [i, j] = net.net.branches[b];
    return (nodes[i] - nodes[j]).norm();
  };
  std::map<std::string, std::pair<int, std::size_t>> collapsed;  // by group: how many, and one of them
  for (std::size_t b = 0; b < net.cables.size(); ++b)
    if (length(found.nodes, b) < nothing * net.drawn_length[static_cast<Eigen::Index>(b)]) {
      auto& [count, one] = collapsed[structure.groups[structure.cables[net.cables[b]].group].name];
      ++count;
      one = b;
    }
  if (collapsed.empty()) return;
  std::string text;
  for (const auto& [group, of] : collapsed) {
    const auto members = net.branches_of(structure, {group}).size();
    text +=
        fmt::format("{}{} of the {} members of \"{}\" from {:.4g} m as drawn to {:.2g} m",
                    text.empty() ? "" : "; ", of.first, members, group,
                    net.drawn_length[static_cast<Eigen::Index>(of.second)], length(found.nodes, of.second));
  }
  found.converged = found.compromise = false;
  found.reason = fmt::format(
      "the net is in equilibrium only where it has collapsed, the ends of members on each other: {}. With "
      "these force densities or tensions nothing keeps them apart: ask for lengths of them (method "
      "constraints) or for forces that balance the drawn shape (method balanced)",
      text);
}

}  // namespace tautline::steps
