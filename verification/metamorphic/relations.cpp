#include "relation.hpp"

#include <utility>

namespace tautline::metamorphic {

const std::vector<Relation>& relations() {
  static const std::vector<Relation> all = [] {
    std::vector<Relation> list;
    for (auto* part : {relations_of_description, relations_of_elements, relations_of_loads,
                       relations_of_symmetry, relations_of_runs, relations_of_analyses})
      for (auto& relation : part()) list.push_back(std::move(relation));
    return list;
  }();
  return all;
}

Outcome unchanged(const Outcome& outcome) {
  return outcome;
}

Trial pair(Json first, Json second, std::function<Outcome(const Outcome&)> expected, double tolerance) {
  Trial trial;
  trial.jobs = {{std::move(first)}, {std::move(second)}};
  trial.judge = [expected = std::move(expected), tolerance](const Outcomes& outcomes) {
    return compare(expected(outcomes[0]), outcomes[1], tolerance);
  };
  return trial;
}

}  // namespace tautline::metamorphic
