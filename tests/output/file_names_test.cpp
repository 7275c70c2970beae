#include <tautline/output/file_names.hpp>

#include <gtest/gtest.h>

#include <filesystem>

namespace tautline::output {
namespace {

TEST(FileNames, LeaveNoFolderAndHideNothing) {
  for (const char* name :
       {"../../x", "/etc/passwd", "..", ".", ".hidden", "a/b", "a\\b", "", "-rf", "a\nb"}) {
    FileNames names;
    const std::string stem = names.of(name);
    EXPECT_EQ(std::filesystem::path(stem).filename().string(), stem) << name;
    EXPECT_FALSE(stem.empty() || stem.front() == '.' || stem.front() == '-') << name;
    EXPECT_EQ(stem.find_first_of("/\\\n"), std::string::npos) << name;
  }
}

TEST(FileNames, AreShort) {
  FileNames names;
  const std::string endless(100000, 'x');
  EXPECT_LT(names.of(endless).size(), 100u);
  EXPECT_LT(names.of(endless + "y").size(), 100u);
}

TEST(FileNames, AreTheSameForOneNameAndOthersForOthers) {
  FileNames names;
  const std::string space = names.of("a b"), line = names.of("a_b"), slash = names.of("a/b");
  EXPECT_EQ(space, "a_b");
  EXPECT_NE(line, space);
  EXPECT_NE(slash, space);
  EXPECT_NE(slash, line);
  EXPECT_EQ(names.of("a b"), space);
  EXPECT_EQ(names.of("a_b"), line);
  EXPECT_NE(names.next("a b"), space);
}

}  // namespace
}  // namespace tautline::output
