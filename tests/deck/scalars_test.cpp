#include <tautline/core/sha256.hpp>
#include <gtest/gtest.h>

#include <deck/scalars.hpp>

namespace tautline::deck {
namespace {

TEST(Scalars, ReadNumbers) {
  EXPECT_EQ(parse_number("12", "m").value, 12);
  EXPECT_EQ(parse_number("-1.5e-3", "m").value, -0.0015);
  EXPECT_EQ(parse_number("+2", "m").value, 2);
  EXPECT_EQ(parse_number(".5", "m").value, 0.5);
  EXPECT_EQ(parse_number("5.", "m").value, 5);
  EXPECT_EQ(parse_number("010", "m").value, 10) << "decimal, as written";
}

TEST(Scalars, RejectWhatIsNoFiniteNumber) {
  for (const char* text : {"", "twelve", "nan", ".nan", "NaN", "inf", "-.inf", "1e999", "0x10", "1 2", "1..2",
                           "--1", "1e", "e5", "1_000"})
    EXPECT_FALSE(parse_number(text, "m").value) << text;
}

TEST(Scalars, TurnAUnitIntoARemedy) {
  EXPECT_EQ(parse_number("10 mm", "m").remedy, "write 0.01");
  EXPECT_EQ(parse_number("12GHz", "Hz").remedy, "write 12000000000");
  EXPECT_EQ(parse_number("3 bar", "Pa").remedy, "write the plain number in Pa");
  EXPECT_EQ(parse_number("12,5", "m").remedy, "write 12.5");
}

TEST(Scalars, ReadWholeNumbers) {
  EXPECT_EQ(parse_integer("8").value, 8);
  EXPECT_EQ(parse_integer("-3").value, -3);
  EXPECT_EQ(parse_integer("0").value, 0);
  for (const char* text : {"010", "2.5", "2.0", "1e3", "", "99999999999", "4 parts", "true"})
    EXPECT_FALSE(parse_integer(text).value) << text;
  EXPECT_EQ(parse_integer("010").remedy, "write 10");
}

TEST(Scalars, ReadOnlyTrueAndFalse) {
  EXPECT_EQ(parse_boolean("true").value, true);
  EXPECT_EQ(parse_boolean("false").value, false);
  for (const char* text : {"yes", "no", "on", "True", "1", "", "maybe"})
    EXPECT_FALSE(parse_boolean(text).value) << text;
  EXPECT_EQ(parse_boolean("no").remedy, "write false");
}

TEST(Sha256, AgreesWithThePublishedVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace
}  // namespace tautline::deck
