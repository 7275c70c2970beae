// What a path that gave up tells of the way it found its end by.
#include <gtest/gtest.h>

#include <tautline/analysis/path.hpp>

#include "analysis/dense_problem.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;

TEST(LastResort, IsTheOneAskedForAndTellsOfTheEndThatItGoesTo) {
  for (const auto method : {LastResort::descent, LastResort::dynamic_relaxation}) {
    DrivenProblem problem(8);
    problem.size = 10;
    auto work = workspace();
    NewtonOptions options;  // no room for Newton's method
    options.max_iterations = 1;
    options.min_step = 0.9;
    PathStart start;
    start.last_resort = method;
    PathCallback callback;
    bool gave_up = false;
    std::vector<double> aims;
    callback.iteration = [&](double aim, int, double) {
      if (gave_up) aims.push_back(aim);
    };
    callback.gave_up = [&](const LastResortSummary& told) {
      gave_up = true;
      EXPECT_EQ(told.method, method);
      EXPECT_EQ(told.gave_up_at, 0);
    };
    const auto summary = follow_path(problem, work, options, callback, start);
    ASSERT_TRUE(summary.reached) << summary.reason;
    ASSERT_TRUE(summary.last_resort);
    EXPECT_EQ(summary.last_resort->method, method);
    EXPECT_GT(summary.last_resort->steps, 0);
    EXPECT_EQ(summary.last_resort->peaks > 0, method == LastResort::dynamic_relaxation)
        << "kinetic energy is a matter of motion";
    ASSERT_FALSE(aims.empty());
    for (const double aim : aims) EXPECT_EQ(aim, 1);
  }
}

}  // namespace
}  // namespace tautline::analysis
