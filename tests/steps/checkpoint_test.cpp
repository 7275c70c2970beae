// A checkpoint is used as it was written, or refused by name.
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <iterator>
#include <tautline/core/error.hpp>

#include "output/temporary_directory.hpp"
#include "steps/checkpoint.hpp"

namespace tautline::steps {
namespace {

namespace fs = std::filesystem;
using output::test::contents;
using output::test::TemporaryDirectory;

deck::Deck a_deck() {
  return deck::parse_deck(deck::starting_deck("frame"), "frame.yaml");
}

/// Two nodes, one beam, numbers of no meaning.
Checkpoint some_checkpoint() {
  const Points two{Vec3(0.1, -2e-7, 3), Vec3(1, 0, 1e300)};
  assembly::Rest rest{{two, {Mat3::Identity(), Mat3::Identity()}, {}, two}, {}, {}};
  rest.acting.force = rest.acting.moment = two;
  rest.acting.line = {Vec3(0, 0, -3)};
  Checkpoint checkpoint;
  checkpoint.steps_done = 1;
  checkpoint.rest = rest;
  return checkpoint;
}

/// A directory of results with one checkpoint of `deck`.
std::string written(const TemporaryDirectory& directory, const deck::Deck& deck) {
  Checkpoints(deck, directory.file("checkpoints")).save(some_checkpoint());
  return directory.file("checkpoints/step_1.bin");
}

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// What finding a checkpoint there says, or nothing if one is found.
std::string refusal(const deck::Deck& deck, const TemporaryDirectory& directory) {
  try {
    find_checkpoint(deck, directory.path());
    return {};
  } catch (const LibraryError& error) {
    return error.what();
  }
}

TEST(Checkpoint, ComesBackBitForBit) {
  const TemporaryDirectory directory("checkpoint_back");
  const auto deck = a_deck();
  written(directory, deck);
  const auto found = find_checkpoint(deck, directory.path());
  ASSERT_TRUE(found && found->rest);
  const auto rest = *some_checkpoint().rest;
  EXPECT_EQ(found->rest->state.displacement, rest.state.displacement);
  EXPECT_EQ(found->rest->acting.line, rest.acting.line);
  EXPECT_EQ(found->steps_done, 1);
}

TEST(Checkpoint, IsRefusedWithAnyOfItsBitsTurned) {
  const TemporaryDirectory directory("checkpoint_bits");
  const auto deck = a_deck();
  const auto path = written(directory, deck);
  const std::string whole = contents(path);
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      put(path, damaged);
      const auto text = refusal(deck, directory);
      ASSERT_NE(text.find(path), std::string::npos) << "byte " << i << ", bit " << bit << ": " << text;
      ASSERT_NE(text.find("run without --from"), std::string::npos) << text;
    }
}

TEST(Checkpoint, IsRefusedCutOffAnywhereOrWithMoreBehindIt) {
  const TemporaryDirectory directory("checkpoint_cut");
  const auto deck = a_deck();
  const auto path = written(directory, deck);
  const std::string whole = contents(path);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    put(path, whole.substr(0, n));
    ASSERT_NE(refusal(deck, directory).find(path), std::string::npos) << n << " bytes left";
  }
  put(path, whole + '\0');
  EXPECT_NE(refusal(deck, directory).find("damaged"), std::string::npos);
  put(path, whole);
  EXPECT_EQ(refusal(deck, directory), "");
}

TEST(Checkpoint, OfAnotherStructureIsRefusedAlsoAmongOwnOnes) {
  const TemporaryDirectory here("checkpoint_own"), there("checkpoint_foreign");
  const auto deck = a_deck();
  const auto other = deck::parse_deck(deck::starting_deck("frame"), "frame.yaml", {"parameters.load=-200"});
  const auto foreign = written(there, other);
  EXPECT_NE(refusal(deck, there).find("another structure"), std::string::npos);
  written(here, deck);
  EXPECT_EQ(refusal(deck, here), "");
  fs::copy_file(foreign, here.file("checkpoints/step_2.bin"));
  EXPECT_NE(refusal(deck, here).find("step_2.bin"), std::string::npos);
}

TEST(Checkpoint, OfAnotherMeshIsRefused) {
  const auto checkpoint = some_checkpoint();
  EXPECT_NO_THROW(require_fit(checkpoint, *checkpoint.rest, "r"));
  auto larger = *checkpoint.rest;
  larger.state.displacement.push_back(Vec3::Zero());
  EXPECT_THROW(require_fit(checkpoint, larger, "r"), LibraryError);
  auto more_beams = *checkpoint.rest;
  more_beams.acting.line.push_back(Vec3::Zero());
  EXPECT_THROW(require_fit(checkpoint, more_beams, "r"), LibraryError);
}

}  // namespace
}  // namespace tautline::steps
