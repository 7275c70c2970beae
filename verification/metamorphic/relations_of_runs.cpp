/// @file
/// Steps, stages, solvers, checkpoints, ranks and `check`: ways to the same state.

#include <algorithm>

#include <fmt/format.h>

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

/// The last equilibrium under control of the load, or -1.
int last_equilibrium(const Json& deck) {
  for (int i = static_cast<int>(deck["steps"].size()) - 1; i >= 0; --i) {
    const Json& step = deck["steps"][static_cast<std::size_t>(i)];
    if (step["kind"] == "equilibrium") return step.contains("control") ? -1 : i;
  }
  return -1;
}

/// Two decks that end in one state, whatever their steps say of the way.
Trial same_end(const Json& first, const Json& second, double tolerance = usual_tolerance) {
  Trial trial;
  trial.jobs = {{first}, {second}};
  trial.judge = [tolerance](const Outcomes& o) {
    return compare(o[0].without("step "), o[1].without("step "), tolerance);
  };
  return trial;
}

/// What comes after the last equilibrium is left out: it adds nothing to the state.
Json until_last_equilibrium(const Json& deck, int last) {
  Json cut = deck;
  while (static_cast<int>(cut["steps"].size()) > last + 1) cut["steps"].erase(cut["steps"].size() - 1);
  return cut;
}

std::optional<Trial> same_step_twice(const Json& deck, Random&) {
  const int last = last_equilibrium(deck);
  if (last < 0) return std::nullopt;
  const Json once = until_last_equilibrium(deck, last);
  Json twice = once;
  Json again = twice["steps"].back();
  again["name"] = "again";
  twice["steps"].push_back(again);
  return same_end(once, twice);
}

std::optional<Trial> increments(const Json& deck, Random& random) {
  const int last = last_equilibrium(deck);
  if (last < 0) return std::nullopt;
  const Json once = until_last_equilibrium(deck, last);
  Json parts = once;
  parts["steps"].back()["increments"] = random.whole(2, 7);
  return same_end(once, parts);
}

/// Some of the last loads come in a step of their own, before the others.
std::optional<Trial> split_steps(const Json& deck, Random& random) {
  const int last = last_equilibrium(deck);
  if (last < 0 || deck["steps"][static_cast<std::size_t>(last)]["loads"].empty()) return std::nullopt;
  const Json once = until_last_equilibrium(deck, last);
  Json split = once;
  Json first = once["steps"].back();
  first["name"] = "some of it";
  Json loads = Json::array();
  for (const auto& name : first["loads"])
    if (random.chance(0.5)) loads.push_back(name);
  first["loads"] = loads;
  split["steps"].insert(split["steps"].begin() + last, first);
  return same_end(once, split);
}

/// Some nodes or members are held in a stage of the first equilibrium, and released in a second.
std::optional<Trial> split_stages(const Json& deck, Random& random) {
  const int last = last_equilibrium(deck);
  if (last < 0) return std::nullopt;
  const Json once = until_last_equilibrium(deck, last);
  std::vector<std::string> names;
  for (const auto& item : deck["groups"].items())
    if (!item.value().contains("edges") && !nodes_of(deck, item.key()).empty()) names.push_back(item.key());
  Json staged = once;
  for (auto& step : staged["steps"]) {
    if (step["kind"] != "equilibrium") continue;
    const Json held{{"name", "held"}, {"hold", Json::array({random.one_of(names)})}}, free{{"name", "free"}};
    step["stages"] = Json::array({held, free});
    break;
  }
  return same_end(once, staged);
}

/// Newton's method is made to fail, and descent or dynamic relaxation finds the state.
std::optional<Trial> other_solver(const Json& deck, Random& random) {
  const int last = last_equilibrium(deck);
  if (last < 0) return std::nullopt;
  const Json newton = until_last_equilibrium(deck, last);
  Json other = newton;
  for (auto& step : other["steps"])
    if (step["kind"] == "equilibrium")
      step["fallback"] = random.chance(0.5) ? "descent" : "dynamic_relaxation";
  other["solver"] = {{"max_iterations", 1}, {"min_step", 0.9}};
  return same_end(newton, other);
}

std::optional<Trial> resume(const Json& deck, Random& random) {
  const int n = static_cast<int>(deck["steps"].size());
  if (n < 2) return std::nullopt;
  Trial trial;
  trial.jobs = {{deck}, {deck, Job::Way::resume, random.whole(1, n - 1)}};
  trial.judge = [](const Outcomes& o) { return compare(o[0], o[1], 1e-9); };
  return trial;
}

std::optional<Trial> two_ranks(const Json& deck, Random&) {
  Trial trial;
  trial.jobs = {{deck}, {deck, Job::Way::two_ranks}};
  trial.judge = [](const Outcomes& o) { return compare(o[0], o[1], 1e-8); };
  return trial;
}

/// Structures of which half lack something.
Json damaged(Random& random) {
  Json deck = any_structure_or_reflector(random);
  if (random.chance(0.4) || !deck.contains("model")) return deck;
  if (random.chance(0.3) && !deck["supports"].empty()) {
    deck["supports"].erase(
        static_cast<std::size_t>(random.whole(0, static_cast<int>(deck["supports"].size()) - 1)));
  } else if (random.chance(0.5)) {
    auto& elements = deck["model"]["elements"];
    auto& list = elements[random.one_of(element_groups(deck))];
    list.erase(static_cast<std::size_t>(random.whole(0, static_cast<int>(list.size()) - 1)));
  } else {
    auto& support = deck["supports"][0];
    support["fix"] = random.chance(0.5) ? Json({"x", "y"}) : Json({"z"});
  }
  tidy(deck);
  return deck;
}

std::optional<Trial> check_and_run(const Json& deck, Random&) {
  Trial trial;
  trial.jobs = {{deck, Job::Way::check}, {deck}};
  trial.any_end = true;
  trial.judge = [](const Outcomes& o) {
    const Outcome &check = o[0], &run = o[1];
    const bool decks = (check.end == "bad deck") == (run.end == "bad deck");
    std::vector<Difference> list;
    if (!decks || (!check.done() && run.done()))
      list.push_back(
          {fmt::format("check: {} {}; run: {} {}", o[0].end, o[0].message, o[1].end, o[1].message), 10});
    return list;
  };
  return trial;
}

}  // namespace

std::vector<Relation> relations_of_runs() {
  const std::string path = "1e-6 of the largest: where Newton's method stops does not depend on the way";
  return {
      {"same_step_twice", "The last equilibrium a second time: nothing moves.", path, any_structure,
       same_step_twice},
      {"increments", "Loads in many equal parts, or at once: the same state.", path, any_structure,
       increments},
      {"split_steps", "Some loads first, the others with them in the next step: the same state.", path,
       any_structure, split_steps},
      {"split_stages", "Parts held in a first stage and released in the next: the same state.", path,
       any_structure, split_stages},
      {"other_solver", "Descent or dynamic relaxation in place of Newton's method: the same state.", path,
       any_structure, other_solver},
      {"resume", "A run taken up from any of its checkpoints gives what the straight run gave.",
       "1e-9: the state is kept with all digits",
       [](Random& r) { return r.chance(0.4) ? reflector(r) : any_structure(r); }, resume},
      {"two_ranks", "One process or two: the same results.", "1e-8 of the largest: sums in another order",
       any_structure_or_reflector, two_ranks},
      {"check_and_run",
       "Errors of a deck are the same for `check` and `run`, and what `check` refuses is not done.",
       "exact; what moves before it fails cannot be foretold, so a run may fail after a check", damaged,
       check_and_run},
  };
}

}  // namespace tautline::metamorphic
