// Damaged, exchanged and forged checkpoints, at random but from a seed. Every test run tries some;
// TAUTLINE_CAMPAIGN=10000 tries as many, and TAUTLINE_CAMPAIGN_RUNS=FILE=DIRECTORY:... on what runs have left
// (scripts/faults does both).
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>

#include "output/temporary_directory.hpp"
#include "steps/checkpoint.hpp"
#include "steps/checkpoint_file.hpp"

namespace tautline::steps {
namespace {

namespace fs = std::filesystem;
using output::test::contents;
using output::test::put;
using output::test::TemporaryDirectory;

/// A deck, and bytes of the checkpoints of one run of it by file name.
struct Run {
  deck::Deck deck;
  std::map<std::string, std::string> files;
};

assembly::Rest some_rest(double size) {
  const Points points{Vec3(0.1, -2e-7, 3), Vec3(1, 0, size), Vec3(4, 5, 6)};
  const Mat3 turned = Eigen::AngleAxisd(0.3, Vec3(1, 2, 2) / 3).toRotationMatrix();
  assembly::Rest rest{{points, {turned, Mat3::Identity(), turned}, {points[0]}, points}, {}, {0.5, 1}};
  rest.acting.force = rest.acting.moment = points;
  rest.acting.line = {Vec3(0, 0, -size)};
  rest.acting.strain = {1e-3, 0};
  rest.acting.temperature = {20};
  return rest;
}

Checkpoint some_checkpoint(int steps_done, double size, bool within) {
  Checkpoint checkpoint;
  checkpoint.steps_done = steps_done;
  checkpoint.acting_loads = {"dead"};
  for (int k = 0; k < steps_done; ++k)
    checkpoint.results["steps"].push_back(
        {{"name", std::to_string(k)}, {"kind", "equilibrium"}, {"status", "done"}, {"rms", size / 3}});
  checkpoint.rest = some_rest(size);
  if (!within) return checkpoint;
  StagePoint point;
  point.stage = 1;
  point.start = some_rest(2 * size);
  point.place.state = some_rest(3 * size).state;
  point.place.lambda = point.place.driven_to = 0.37;
  point.arc = analysis::ArcPlace{0.1, 0.2, 1, 1, -1, 7, 1, 0};
  point.entry = Json::array({{{"name", "first"}, {"status", "done"}}});
  point.way = Json::array({{{"lambda", 0.2}, {"reactions", {1.5, 2, 3}}}});
  point.critical = Json::array();
  checkpoint.point = point;
  return checkpoint;
}

/// A frame after one step, then within the next.
Run some_run(const std::string& load, double size) {
  Run run{deck::parse_deck(deck::starting_deck("frame"), "frame.yaml", {"parameters.load=" + load}), {}};
  Step equilibrium;
  equilibrium.options = EquilibriumOptions{};
  run.deck.steps = {equilibrium, equilibrium};
  run.deck.step_fingerprints = {"first", "second"};
  const TemporaryDirectory directory("campaign_run");
  Checkpoints checkpoints(run.deck, directory.file("checkpoints"));
  checkpoints.save(some_checkpoint(1, size, false));
  checkpoints.save_point(some_checkpoint(1, size, true), true);
  for (const char* name : {"step_1.bin", "point.bin"})
    run.files[name] = contents(directory.file(std::string("checkpoints/") + name));
  return run;
}

std::vector<Run> runs() {
  const char* given = std::getenv("TAUTLINE_CAMPAIGN_RUNS");
  if (given == nullptr) return {some_run("-100", 1), some_run("-100", 7), some_run("-200", 1)};
  std::vector<Run> list;
  std::istringstream stream(given);
  for (std::string one; std::getline(stream, one, ':');) {
    const auto equals = one.find('=');
    std::istringstream deck(contents(one.substr(0, equals)));  // its path, then what is set in it
    std::string path;
    std::getline(deck, path);
    std::vector<std::string> settings;
    for (std::string setting; std::getline(deck, setting);) settings.push_back(setting);
    Run run{deck::read_deck(path, settings), {}};
    for (const auto& entry : fs::directory_iterator(one.substr(equals + 1) + "/checkpoints"))
      run.files[entry.path().filename().string()] = contents(entry.path().string());
    list.push_back(std::move(run));
  }
  return list;
}

class Campaign {
 public:
  explicit Campaign(std::vector<Run> runs, unsigned seed) : runs_(std::move(runs)), random_(seed) {}

  std::size_t below(std::size_t n) {
    return n == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  const Run& any_run() { return runs_[below(runs_.size())]; }
  const std::string& any_file(const Run& run) {
    return std::next(run.files.begin(), static_cast<long>(below(run.files.size())))->second;
  }

  std::string flipped(std::string bytes) {
    for (std::size_t n = 1 + below(8); n-- > 0;) {
      char& byte = bytes[below(bytes.size())];
      byte = static_cast<char>(byte ^ (1 << below(8)));
    }
    return bytes;
  }
  std::string cut(const std::string& bytes) { return bytes.substr(0, below(bytes.size())); }
  std::string swapped(const std::string& bytes) {
    const std::size_t n = 1 + below(std::min<std::size_t>(4096, bytes.size() / 2));
    const std::size_t a = below(bytes.size() / 2 - n + 1),
                      b = bytes.size() / 2 + below(bytes.size() / 2 - n + 1);
    std::string result = bytes;
    result.replace(a, n, bytes, b, n);
    result.replace(b, n, bytes, a, n);
    return result;
  }
  /// A block of zeros or of another file, as a disk may return it.
  std::string patched(std::string bytes) {
    const std::string& source = any_file(any_run());
    const std::size_t n = 1 + below(std::min({std::size_t{4096}, bytes.size(), source.size()}));
    const std::size_t at = below(bytes.size() - n + 1);
    return below(2) == 0 ? bytes.replace(at, n, n, '\0')
                         : bytes.replace(at, n, source, below(source.size() - n + 1), n);
  }
  std::string longer(const std::string& bytes) {
    return bytes + any_file(any_run()).substr(0, 1 + below(4096));
  }

  /// With a fitting checksum: bytes, sizes or values of the text that are not as they were.
  std::string forged(const std::string& bytes) {
    std::string content = bytes.substr(bytes.find('\n', bytes.find('\n') + 1) + 1);
    switch (below(5)) {
      case 0:
        return sealed(flipped(content));
      case 1:
        return sealed(cut(content));
      case 2:
        return sealed(patched(content));
      case 3:
        return sealed(other_number(content));
      default:
        return sealed(other_value(content));
    }
  }

 private:
  std::string other_number(std::string content) {
    const std::size_t at = below(2) == 0 ? 0 : below(content.size() - 8);
    const std::uint64_t values[] = {
        0, 1, ~0ULL, 1ULL << 62, 0x7ff8000000000000ULL, 0x7ff0000000000000ULL, random_()};
    const std::uint64_t value = values[below(std::size(values))];
    for (std::size_t i = 0; i < 8; ++i) content[at + i] = static_cast<char>(value >> 8 * i & 0xff);
    return content;
  }
  /// Any value of the text in place of another.
  std::string other_value(const std::string& content) {
    std::uint64_t n = 0;
    for (std::size_t i = 8; i-- > 0;) n = n << 8 | static_cast<unsigned char>(content[i]);
    Json text = Json::parse(content.substr(8, n));
    Json* at = &text;
    while (at->is_structured() && !at->empty() && (at == &text || below(4) != 0))
      at = &*std::next(at->begin(), static_cast<long>(below(at->size())));
    const Json values[] = {nullptr,       true,           "x",   -1, 1e300, 3'000'000'000,
                           Json::array(), Json::object(), deep()};
    *at = values[below(std::size(values))];
    const std::string fresh = text.dump();
    std::string size;
    for (int shift = 0; shift < 64; shift += 8) size += static_cast<char>(fresh.size() >> shift & 0xff);
    return size + fresh + content.substr(8 + n);
  }
  static Json deep() {
    Json value;
    for (int i = 0; i < 100; ++i) value = Json::array({value});
    return value;
  }

  std::vector<Run> runs_;
  std::mt19937_64 random_;
};

/// What comes of a directory with these checkpoints: refused by name, one that a run wrote, or something
/// else.
enum class Outcome { refused, genuine, other };

Outcome outcome(const Run& run, const std::map<std::string, std::string>& files,
                const TemporaryDirectory& directory, const std::vector<Run>& all) {
  const std::string folder = directory.file("checkpoints");
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(folder)) fs::remove(entry.path());
  for (const auto& [name, bytes] : files) put(folder + "/" + name, bytes);
  std::optional<Checkpoint> found;
  try {
    found = find_checkpoint(run.deck, directory.path());
  } catch (const LibraryError& error) {
    EXPECT_NE(std::string(error.what()).find("run without --from"), std::string::npos) << error.what();
    return Outcome::refused;
  }
  if (!found) return Outcome::genuine;  // those of other steps are passed over
  const auto& steps = run.deck.step_fingerprints;
  const long n = found->steps_done + (found->point ? 1 : 0);
  const std::string again = encode({run.deck.fingerprint, {steps.begin(), steps.begin() + n}, *found});
  for (const auto& other : all)
    for (const auto& [name, bytes] : other.files)
      if (bytes == again) return Outcome::genuine;
  return Outcome::other;
}

int times() {
  const char* asked = std::getenv("TAUTLINE_CAMPAIGN");
  return asked == nullptr ? 100 : std::atoi(asked);
}

/// Applies `change` to one file of one run, `times` times. @return how often each outcome came
template <class Change>
std::map<Outcome, int> tried(const char* name, unsigned seed, const Change& change) {
  const auto all = runs();
  Campaign campaign(all, seed);
  const TemporaryDirectory directory("campaign");
  std::map<Outcome, int> outcomes;
  for (const auto& run : all) EXPECT_EQ(outcome(run, run.files, directory, all), Outcome::genuine);
  for (int i = 0; i < times(); ++i) {
    const Run& run = all[campaign.below(all.size())];
    auto files = run.files;
    auto& bytes = std::next(files.begin(), static_cast<long>(campaign.below(files.size())))->second;
    const std::string before = bytes;
    bytes = change(campaign, bytes);
    const auto came = outcome(run, files, directory, all);
    if (bytes != before) ++outcomes[came];
  }
  std::printf("%-10s refused %d, used as a run wrote it %d, other %d\n", name, outcomes[Outcome::refused],
              outcomes[Outcome::genuine], outcomes[Outcome::other]);
  return outcomes;
}

TEST(CheckpointCampaign, DamageIsRefused) {
  const auto outcomes = tried("damaged", 1, [](Campaign& campaign, const std::string& bytes) {
    switch (campaign.below(5)) {
      case 0:
        return campaign.flipped(bytes);
      case 1:
        return campaign.cut(bytes);
      case 2:
        return campaign.swapped(bytes);
      case 3:
        return campaign.patched(bytes);
      default:
        return campaign.longer(bytes);
    }
  });
  EXPECT_EQ(outcomes.size(), 3U);  // with the two that printing looked up
  EXPECT_EQ(outcomes.at(Outcome::genuine) + outcomes.at(Outcome::other), 0);
}

TEST(CheckpointCampaign, FilesOfOtherRunsAndStepsAreRefusedOrWhatTheyAre) {
  const auto outcomes = tried("exchanged", 2, [](Campaign& campaign, const std::string&) {
    return campaign.any_file(campaign.any_run());
  });
  EXPECT_GT(outcomes.at(Outcome::refused), 0);
  EXPECT_GT(outcomes.at(Outcome::genuine), 0);
  EXPECT_EQ(outcomes.at(Outcome::other), 0);
}

TEST(CheckpointCampaign, ForgeriesAreRefusedOrRead) {  // and never another exception, nor a crash
  const auto outcomes =
      tried("forged", 3, [](Campaign& campaign, const std::string& bytes) { return campaign.forged(bytes); });
  EXPECT_GT(outcomes.at(Outcome::refused), times() / 4);
  EXPECT_GT(outcomes.at(Outcome::other),
            0);  // e.g. another digit of a number: whoever forges that can also run the program
}

}  // namespace
}  // namespace tautline::steps
