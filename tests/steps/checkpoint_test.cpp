// A checkpoint is used as it was written, or refused by name.
#include <csignal>
#include <cstddef>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <tautline/core/error.hpp>

#include "output/temporary_directory.hpp"
#include "steps/checkpoint.hpp"
#include "steps/checkpoint_file.hpp"

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
  checkpoint.results["steps"].push_back({{"name", "first"}, {"kind", "equilibrium"}, {"status", "done"}});
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
  std::string bytes = contents(path);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      const char turned = static_cast<char>(1 << bit);
      bytes[i] = static_cast<char>(bytes[i] ^ turned);
      ASSERT_THROW(decode(bytes), BadCheckpoint) << "byte " << i << ", bit " << bit;
      if (bit == 3 && i % 100 == 0) {
        put(path, bytes);
        const auto text = refusal(deck, directory);
        ASSERT_NE(text.find(path), std::string::npos) << "byte " << i << ": " << text;
        ASSERT_NE(text.find("run without --from"), std::string::npos) << text;
      }
      bytes[i] = static_cast<char>(bytes[i] ^ turned);
    }
}

TEST(Checkpoint, IsRefusedCutOffAnywhereOrWithMoreBehindIt) {
  const TemporaryDirectory directory("checkpoint_cut");
  const auto deck = a_deck();
  const auto path = written(directory, deck);
  const std::string whole = contents(path);
  for (std::size_t n = 0; n < whole.size(); ++n)
    ASSERT_THROW(decode(whole.substr(0, n)), BadCheckpoint) << n << " bytes left";
  put(path, whole.substr(0, whole.size() / 2));
  EXPECT_NE(refusal(deck, directory).find(path), std::string::npos);
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

/// What a file with a fitting checksum and this change in its text or lists is refused with.
template <class Change>
std::string forged(const Change& change) {
  const TemporaryDirectory directory("checkpoint_forged");
  const auto deck = a_deck();
  const auto path = written(directory, deck);
  std::string bytes = contents(path);
  std::string content = bytes.substr(bytes.find('\n', bytes.find('\n') + 1) + 1);
  change(content);
  put(path, sealed(content));
  return refusal(deck, directory);
}

std::size_t length_of_text(const std::string& content) {
  std::size_t n = 0;
  for (std::size_t i = 8; i-- > 0;) n = n << 8U | static_cast<unsigned char>(content[i]);
  return n;
}

/// Puts another text in place of the one that is there, its length included.
void set_text(std::string& content, const std::string& text) {
  const std::string lists = content.substr(8 + length_of_text(content));
  content.clear();
  for (int shift = 0; shift < 64; shift += 8) content += static_cast<char>(text.size() >> shift & 0xffU);
  content += text + lists;
}

TEST(Checkpoint, WithAFittingChecksumButForeignContentIsRefused) {
  EXPECT_EQ(forged([](std::string&) {}), "");
  const auto set = [](std::size_t at, unsigned char byte) {
    return [=](std::string& content) { content[8 + length_of_text(content) + at] = static_cast<char>(byte); };
  };
  const auto says = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
    EXPECT_NE(text.find("step_1.bin"), std::string::npos) << text;
  };
  says(forged(set(7, 0x7f)), "longer than the file");  // the first list's length
  says(forged(set(0, 5)), "ends within one");          // five numbers are no vectors
  says(forged([&](std::string& content) {              // the first displacement, NaN
         set(8 + 6, 0xf8)(content);
         set(8 + 7, 0x7f)(content);
       }),
       "not finite");
  says(forged(set(8 + 6 * 8 + 8 + 7, 0xbf)), "rotation");  // -1 in an identity
  says(forged([](std::string& content) { content += "12345678"; }), "more than its lists");
  says(forged([](std::string& content) { content.pop_back(); }), "");
  says(forged([](std::string& content) { content.clear(); }), "ends within");
}

TEST(Checkpoint, WithAFittingChecksumButForeignTextIsRefused) {
  const std::pair<const char*, const char*> changes[] = {
      {"\"steps_done\":1", "\"steps_done\":1e9"},
      {"\"steps_done\":1", "\"steps_done\":-1"},
      {"\"steps_done\":1", "\"steps_done\":2"},
      {"\"steps_done\":1", "\"steps_done\":\"1\""},
      {"\"acting_loads\":[]", "\"acting_loads\":[3]"},
      {"\"acting_loads\":[]", "\"acting_loads\":7"},
      {"\"rest\":true", "\"rest\":1"},
      {"\"rest\":true", "\"rest\":false"},
      {"\"point\":null", "\"point\":{}"},
      {"\"point\":null", "\"point\":[]"},
      {"\"name\":\"first\"", "\"name\":5"},
      {"\"warnings\":[]", "\"warnings\":[1]"},
      {"\"warnings\":[]", "\"warning\":[]"},
      {"{", "["},
  };
  for (const auto& [from, to] : changes) {
    const auto text = forged([from = from, to = to](std::string& content) {
      std::string changed = content.substr(8, length_of_text(content));
      const auto at = changed.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      set_text(content, changed.replace(at, std::string(from).size(), to));
    });
    EXPECT_NE(text.find("holds what no run writes"), std::string::npos) << to << ": " << text;
  }
  for (const std::size_t depth : {100U, 1'000'000U})
    EXPECT_NE(forged([=](std::string& content) {
                set_text(content, std::string(depth, '['));
              }).find("lists in lists"),
              std::string::npos);
}

TEST(Checkpoint, ThatIsNoFileIsRefused) {
  const TemporaryDirectory directory("checkpoint_no_file");
  fs::create_directories(directory.file("checkpoints/step_1.bin"));
  EXPECT_NE(refusal(a_deck(), directory).find("is no file"), std::string::npos);
  fs::remove(directory.file("checkpoints/step_1.bin"));
  fs::create_symlink("/dev/zero", directory.file("checkpoints/step_1.bin"));  // without an end
  EXPECT_NE(refusal(a_deck(), directory).find("is no file"), std::string::npos);
}

TEST(Checkpoint, ThatCannotBeWrittenLeavesTheOneBefore) {
  const TemporaryDirectory directory("checkpoint_full");
  const auto deck = a_deck();
  const auto path = written(directory, deck);
  const std::string before = contents(path);
  rlimit old{}, none{};
  getrlimit(RLIMIT_FSIZE, &old);
  none = old;
  none.rlim_cur = before.size() / 2;  // as a full disk: the write ends half-way
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &none);
  Checkpoints checkpoints(deck, directory.file("checkpoints"));
  EXPECT_THROW(checkpoints.save(some_checkpoint()), LibraryError);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(contents(path), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(directory.file("checkpoints")), {}), 1);
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
