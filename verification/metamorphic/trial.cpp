#include "trial.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

namespace tautline::metamorphic {

namespace {

bool is_ours(const std::string& end) {
  return end == "bug" || end == "library failed";
}

std::string told(const Outcomes& outcomes) {
  std::string text;
  for (const auto& outcome : outcomes)
    text += fmt::format("{}{}{}", text.empty() ? "" : " | ", outcome.end,
                        outcome.message.empty() ? "" : ": " + outcome.message.substr(0, 300));
  return text;
}

/// What may be taken away from a deck, one after the other.
std::vector<Json> smaller(const Json& deck) {
  std::vector<Json> list;
  const auto add = [&](auto&& change) {
    Json candidate = deck;
    change(candidate);
    tidy(candidate);
    if (candidate != deck) list.push_back(std::move(candidate));
  };
  for (const char* block : {"steps", "loads", "supports"})
    for (std::size_t i = deck[block].size(); i-- > 0;) add([&](Json& d) { d[block].erase(i); });
  if (deck.contains("model")) {
    for (const auto& [group, elements] : deck["model"]["elements"].items())
      add([&, name = group](Json& d) { d["model"]["elements"].erase(name); });
    for (const auto& [group, elements] : deck["model"]["elements"].items())
      for (std::size_t i = elements.size(); i-- > 0;)
        add([&, name = group](Json& d) { d["model"]["elements"][name].erase(i); });
  }
  for (const auto& [name, group] : deck["groups"].items())
    for (const char* key : {"orientation", "offset_start", "offset_end", "release_start", "release_end",
                            "tension", "prestrain", "force_density", "prestress"})
      if (group.contains(key)) add([&, n = name](Json& d) { d["groups"][n].erase(key); });
  for (std::size_t s = 0; s < deck["steps"].size(); ++s) {
    if (!deck["steps"][s].contains("loads")) continue;
    for (std::size_t i = deck["steps"][s]["loads"].size(); i-- > 0;)
      add([&](Json& d) { d["steps"][s]["loads"].erase(i); });
  }
  for (const int digits : {2, 4})
    add([&](Json& d) {
      const std::function<void(Json&)> shorten = [&](Json& value) {
        if (value.is_number_float()) value = std::stod(fmt::format("{:.{}g}", value.get<double>(), digits));
        if (value.is_structured())
          for (auto& item : value) shorten(item);
      };
      if (d.contains("model")) shorten(d["model"]);
      shorten(d["loads"]);
      shorten(d["groups"]);
      shorten(d["sections"]);
    });
  return list;
}

}  // namespace

Verdict try_relation(const Relation& relation, const Json& deck, std::uint64_t seed, Runner& runner) {
  Random random(seed, relation.name + " again");
  Verdict verdict;
  const std::optional<Trial> trial = relation.derive(deck, random);
  if (!trial) return verdict;
  verdict.trial = *trial;
  Outcomes outcomes;
  for (const auto& job : trial->jobs) outcomes.push_back(runner.run(job));
  const auto all_done = [&] {
    return std::all_of(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.done(); });
  };
  if (trial->then && all_done())
    for (const auto& job : trial->then(outcomes)) {
      verdict.trial.jobs.push_back(job);
      outcomes.push_back(runner.run(job));
    }
  verdict.n_done = static_cast<int>(
      std::count_if(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.done(); }));
  const bool ours =
      std::any_of(outcomes.begin(), outcomes.end(), [](const auto& o) { return is_ours(o.end); });
  const bool alike = std::all_of(outcomes.begin(), outcomes.end(),
                                 [&](const auto& o) { return o.end == outcomes.front().end; });
  if (!all_done()) verdict.ends = told(outcomes);
  if (ours || (!alike && !trial->any_end)) {
    verdict.kind = Verdict::Kind::ends_differ;
  } else if (!all_done() && !trial->any_end) {
    verdict.kind = Verdict::Kind::discarded;
  } else {
    verdict.differences = trial->judge(outcomes);
    verdict.kind = verdict.worst() > 1 ? Verdict::Kind::numbers_differ : Verdict::Kind::holds;
  }
  return verdict;
}

namespace {

/// As try_relation(), of a deck that something was taken from: it may lack what the relation needs.
Verdict try_smaller(const Relation& relation, const Json& deck, std::uint64_t seed, Runner& runner) {
  try {
    return try_relation(relation, deck, seed, runner);
  } catch (const Json::exception&) {
    return {};
  }
}

}  // namespace

Json smallest(const Relation& relation, Json deck, std::uint64_t seed, Runner& runner, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  const auto first = try_relation(relation, deck, seed, runner);
  for (bool shrunk = true; shrunk;) {
    shrunk = false;
    for (auto& candidate : smaller(deck)) {
      if (Clock::now() > end) return deck;
      const auto verdict = try_smaller(relation, candidate, seed, runner);
      if (verdict.kind != first.kind || verdict.n_done != first.n_done) continue;
      deck = std::move(candidate);
      shrunk = true;
      break;
    }
  }
  return deck;
}

}  // namespace tautline::metamorphic
