#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <tautline/output/pointer.hpp>

using tautline::output::numbers_at;

namespace {

const auto results = nlohmann::ordered_json::parse(R"({
  "mass": 67.2,
  "steps": [
    {"name": "first step", "rms": [3, 2, 1]},
    {"name": "tuning", "iterations": [{"rms": 5}, {"rms": 4}], "reason": "done"}
  ]})");

}  // namespace

TEST(Pointer, FollowsNamesIndicesAndPlaces) {
  EXPECT_EQ(numbers_at(results, "/mass"), std::vector<double>{67.2});
  EXPECT_EQ(numbers_at(results, "/steps/first step/rms"), (std::vector<double>{3, 2, 1}));
  EXPECT_EQ(numbers_at(results, "/steps/0/rms/1"), std::vector<double>{2});
  EXPECT_EQ(numbers_at(results, "/steps/tuning/iterations/last/rms"), std::vector<double>{4});
  EXPECT_EQ(numbers_at(results, "/steps/tuning/iterations/*/rms"), (std::vector<double>{5, 4}));
}

TEST(Pointer, SaysWhatThereIsInstead) {
  const auto message = [](const char* path) -> std::string {
    try {
      numbers_at(results, path);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(message("/weight"), "there is no \"weight\"; there is mass, steps");
  EXPECT_EQ(message("/steps/modal"), "there is no \"modal\"; there is first step, tuning");
  EXPECT_EQ(message("/steps/tuning/reason"), "is no number; there is nothing below it");
}
