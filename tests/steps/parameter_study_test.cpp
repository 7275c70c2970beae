#include <gtest/gtest.h>

#include <tautline/core/error.hpp>
#include <tautline/steps/parameter_study.hpp>

using namespace tautline;
using namespace tautline::steps;

TEST(ParameterStudy, ReadsARange) {
  const auto range = read_range("reflector.rings=8,10,12");
  EXPECT_EQ(range.name, "reflector.rings");
  EXPECT_EQ(range.values, (std::vector<std::string>{"8", "10", "12"}));
}

TEST(ParameterStudy, RefusesWhatIsNoRange) {
  for (const char* text : {"rings", "=8", "rings=", "rings=8,,9"})
    EXPECT_THROW(read_range(text), DeckError) << text;
}

TEST(ParameterStudy, ReadsAQuantityWithAndWithoutLabel) {
  const auto labelled = read_quantity("RMS [m]=/steps/tuning/surface/rms");
  EXPECT_EQ(labelled.label, "RMS [m]");
  EXPECT_EQ(labelled.path, "/steps/tuning/surface/rms");
  EXPECT_EQ(read_quantity("/model/mass").label, "/model/mass");
  EXPECT_EQ(read_quantity("cloth [N/m]=/steps/0/groups/cloth/principal_max").label, "cloth [N/m]");
  EXPECT_THROW(read_quantity("mass"), DeckError);
  EXPECT_THROW(read_quantity("mass /model/mass"), DeckError);
}

TEST(ParameterStudy, CombinesEveryValueWithEveryOther) {
  const auto all = combinations({{"rings", {"8", "10"}}, {"reflector.struts", {"12", "24", "48"}}});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0], (std::vector<std::string>{"parameters.rings=8", "reflector.struts=12"}));
  EXPECT_EQ(all[1], (std::vector<std::string>{"parameters.rings=8", "reflector.struts=24"}));
  EXPECT_EQ(all[5], (std::vector<std::string>{"parameters.rings=10", "reflector.struts=48"}));
}
