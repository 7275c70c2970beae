#include <tautline/output/results.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tautline/core/error.hpp>
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

using Json = nlohmann::ordered_json;
using test::contents;
using test::message_of;
using test::put;
using test::TemporaryDirectory;

TEST(Results, NumbersComeBackBitForBit) {
  const TemporaryDirectory directory("results_digits");
  const Json written = {
      {"third", 1.0 / 3.0}, {"list", {0.1, M_PI, 1e-300, 6.02214076e23}}, {"count", 3}, {"one", 1.0}};
  write_results(directory.file("results.json"), written);
  const Json read = read_results(directory.file("results.json"));
  EXPECT_EQ(read, written);
  EXPECT_EQ(read["third"].get<double>(), 1.0 / 3.0);
  EXPECT_TRUE(read["one"].is_number_float());
  EXPECT_TRUE(read["count"].is_number_integer());
}

TEST(Results, NonFiniteNumbersBecomeNull) {
  const TemporaryDirectory directory("results_nan");
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  write_results(directory.file("results.json"), Json{{"a", nan}, {"b", {1.0, -infinity}}});
  const Json read = read_results(directory.file("results.json"));
  EXPECT_TRUE(read["a"].is_null());
  EXPECT_TRUE(read["b"][1].is_null());
  EXPECT_EQ(read["b"][0], 1.0);
}

TEST(Results, OrderNestingAndTextSurvive) {
  const TemporaryDirectory directory("results_order");
  const Json written =
      Json::parse(R"({"z": {"empty": {}, "none": []}, "a": [[1, 2], {"k": "\"q\" \\ \n ü"}], "t": true})");
  write_results(directory.file("results.json"), written);
  const Json read = read_results(directory.file("results.json"));
  EXPECT_EQ(read.dump(), written.dump());
}

TEST(Results, AreReplacedWholeAndLeaveNoTemporaryFile) {
  const TemporaryDirectory directory("results_atomic");
  const std::string path = directory.file("results.json");
  write_results(path, Json{{"run", 1}});
  write_results(path, Json{{"run", 2}});
  EXPECT_EQ(read_results(path)["run"], 2);
  EXPECT_EQ(directory.entries(), 1u);
}

TEST(Results, FailedWriteNamesTheFileAndTheReason) {
  const TemporaryDirectory directory("results_fail");
  put(directory.file("plain"), "x");
  const std::string path = directory.file("plain/results.json");
  const auto message = message_of<LibraryError>([&] { write_results(path, Json{}); });
  EXPECT_NE(message.find(path), std::string::npos) << message;
  EXPECT_NE(message.find("Not a directory"), std::string::npos) << message;
}

TEST(Results, UnreadableOrBrokenFileIsNamed) {
  const TemporaryDirectory directory("results_broken");
  put(directory.file("broken.json"), "{\"a\": ");
  EXPECT_NE(
      message_of<LibraryError>([&] { read_results(directory.file("broken.json")); }).find("broken.json"),
      std::string::npos);
  EXPECT_NE(
      message_of<LibraryError>([&] { read_results(directory.file("absent.json")); }).find("No such file"),
      std::string::npos);
}

TEST(PrepareDirectory, MakesParentsAndLeavesNothingBehind) {
  const TemporaryDirectory directory("prepare");
  prepare_directory(directory.file("a/b/c"));
  prepare_directory(directory.file("a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(directory.file("a/b/c")));
  EXPECT_TRUE(std::filesystem::is_empty(directory.file("a/b/c")));
}

TEST(PrepareDirectory, RefusesAFileAndAPathBelowAFile) {
  const TemporaryDirectory directory("prepare_file");
  const std::string file = directory.file("plain");
  put(file, "x");
  const auto message = message_of<LibraryError>([&] { prepare_directory(file); });
  EXPECT_NE(message.find("it is a file"), std::string::npos) << message;
  const auto below = message_of<LibraryError>([&] { prepare_directory(file + "/results"); });
  EXPECT_NE(below.find(file + "/results"), std::string::npos) << below;
  EXPECT_NE(below.find("Not a directory"), std::string::npos) << below;
}

}  // namespace
}  // namespace tautline::output
