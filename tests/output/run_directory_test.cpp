#include <tautline/output/run_directory.hpp>

#include <filesystem>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>
#include <tautline/output/results.hpp>
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

namespace fs = std::filesystem;
using test::contents;
using test::message_of;
using test::put;
using test::TemporaryDirectory;

/// A run that writes files of these names.
void run(const std::string& directory, const std::vector<std::string>& names, bool goes_on = false) {
  RunDirectory files(directory);
  files.open(goes_on);
  for (const auto& name : names) write_text(files.path(name), "of this run");
}

TEST(RunDirectory, RemovesWhatAnEarlierRunLeftAndNothingElse) {
  const TemporaryDirectory directory("run_directory_clear");
  run(directory.file("r"), {"results.json", "cables.csv"});
  fs::create_directories(directory.file("r/fields"));
  fs::create_directories(directory.file("r/pictures"));
  for (const char* name :
       {"r/fields/a.vtu", "r/fields/b.pvtu", "r/fields/notes.txt", "r/pictures/x.png", "r/mine.csv"})
    put(directory.file(name), "x");
  run(directory.file("r"), {"results.json"});
  EXPECT_EQ(contents(directory.file("r/results.json")), "of this run");
  for (const char* gone : {"r/cables.csv", "r/fields/a.vtu", "r/fields/b.pvtu", "r/pictures"})
    EXPECT_FALSE(fs::exists(directory.file(gone))) << gone;
  for (const char* stays : {"r/mine.csv", "r/fields/notes.txt"})
    EXPECT_TRUE(fs::exists(directory.file(stays))) << stays;
}

TEST(RunDirectory, KnowsTheFilesOfARunThatWasKilled) {
  const TemporaryDirectory directory("run_directory_killed");
  {
    RunDirectory files(directory.file("r"));
    files.open(false);
    put(files.path("nodes.csv"), "half");  // and no end of the run
    EXPECT_NE(contents(directory.file("r/.tautline_files")).find("nodes.csv\n"), std::string::npos);
  }
  run(directory.file("r"), {});
  EXPECT_FALSE(fs::exists(directory.file("r/nodes.csv")));
}

TEST(RunDirectory, RemovesWhatAKilledRunHadHalfWrittenAlsoWhenItGoesOn) {
  const TemporaryDirectory directory("run_directory_half");
  for (const bool goes_on : {true, false}) {
    run(directory.file("r"), {"results.json"});
    fs::create_directories(directory.file("r/checkpoints"));
    const char* half[] = {"r/results.json.4711.tmp", "r/checkpoints/point.bin.4711.tmp",
                          "r/.tautline_probe_4711"};
    const char* of_others[] = {"r/mine.4711.tmp", "r/results.json.tmp", "r/checkpoints/notes.4711.tmp"};
    for (const char* name : half) put(directory.file(name), "x");
    for (const char* name : of_others) put(directory.file(name), "x");
    run(directory.file("r"), {}, goes_on);
    for (const char* name : half) EXPECT_FALSE(fs::exists(directory.file(name))) << name;
    for (const char* name : of_others) EXPECT_TRUE(fs::exists(directory.file(name))) << name;
  }
}

TEST(RunDirectory, KeepsWhatARunGoesOnFrom) {
  const TemporaryDirectory directory("run_directory_goes_on");
  run(directory.file("r"), {"cables.csv"});
  run(directory.file("r"), {"nodes.csv"}, true);
  EXPECT_TRUE(fs::exists(directory.file("r/cables.csv")));
  run(directory.file("r"), {});
  EXPECT_FALSE(fs::exists(directory.file("r/cables.csv")));
  EXPECT_FALSE(fs::exists(directory.file("r/nodes.csv")));
}

TEST(RunDirectory, IsOneRunsAtATime) {
  const TemporaryDirectory directory("run_directory_lock");
  RunDirectory first(directory.file("r"));
  first.open(false);
  RunDirectory second(directory.file("r"));
  const std::string told = message_of<LibraryError>([&] { second.open(false); });
  EXPECT_NE(told.find("another run (process "), std::string::npos) << told;
  EXPECT_NE(told.find(directory.file("r")), std::string::npos) << told;
}

TEST(RunDirectory, TakesOverTheLockOfARunThatIsNoMore) {
  const TemporaryDirectory directory("run_directory_stale");
  fs::create_directories(directory.file("r"));
  put(directory.file("r/.tautline_lock"), "process 1 on elsewhere\n");
  EXPECT_NO_THROW(run(directory.file("r"), {"nodes.csv"}));
}

/// A list that somebody else has written cannot remove what lies elsewhere.
TEST(RunDirectory, RemovesNothingOutside) {
  const TemporaryDirectory directory("run_directory_outside");
  fs::create_directories(directory.file("r/below"));
  put(directory.file("precious.txt"), "x");
  put(directory.file("r/below/precious.txt"), "x");
  put(directory.file("r/.tautline_files"),
      "../precious.txt\nbelow/precious.txt\nbelow\n..\n" + directory.file("precious.txt") + "\n");
  run(directory.file("r"), {});
  EXPECT_TRUE(fs::exists(directory.file("precious.txt")));
  EXPECT_TRUE(fs::exists(directory.file("r/below/precious.txt")));
}

TEST(RunDirectory, WritesThroughNoLink) {
  const TemporaryDirectory directory("run_directory_links");
  fs::create_directories(directory.file("r"));
  fs::create_directories(directory.file("elsewhere"));
  put(directory.file("precious.txt"), "x");
  fs::create_symlink(directory.file("precious.txt"), directory.file("r/nodes.csv"));
  run(directory.file("r"), {"nodes.csv"});
  EXPECT_EQ(contents(directory.file("precious.txt")), "x");
  EXPECT_EQ(contents(directory.file("r/nodes.csv")), "of this run");
  fs::create_directory_symlink(directory.file("elsewhere"), directory.file("r/pictures"));
  EXPECT_NE(message_of<LibraryError>([&] { run(directory.file("r"), {}); }).find("pictures is a link"),
            std::string::npos);
}

}  // namespace
}  // namespace tautline::output
