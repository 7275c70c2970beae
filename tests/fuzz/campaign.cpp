#include "campaign.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/output/report.hpp>
#include <tautline/output/results.hpp>
#include <tautline/steps/run.hpp>

#include "deck_mutator.hpp"
#include "mesh_mutator.hpp"

namespace tautline::fuzz {

namespace {

namespace fs = std::filesystem;

/// Does something with an input and tells how it ended.
Answer guarded(const std::string& file, const std::string& text, const std::function<std::string()>& action) {
  try {
    return {action(), {}, {}};
  } catch (const DeckError& error) {
    return {"bad deck", fault_of(error, file, text), error.what()};
  } catch (const ModelError& error) {
    return {"impossible model", fault_of_message(error.what()), error.what()};
  } catch (const LibraryError& error) {
    return {"library failed", fault_of_message(error.what()), error.what()};
  } catch (const std::bad_alloc&) {
    return {"no memory", "too much memory: std::bad_alloc", {}};
  } catch (const std::length_error& error) {
    return {"no memory", fmt::format("too much memory: {}", error.what()), {}};
  } catch (const std::exception& error) {
    return {"bug", fmt::format("bug: {}", error.what()), error.what()};
  } catch (...) {
    return {"bug", "bug: something that is no exception of the standard library", {}};
  }
}

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A mutant is read as if it stood beside its seed, so that the meshes are found.
std::string name_beside(const std::string& seed) {
  return (fs::path(seed).parent_path() / "mutant.yaml").string();
}

std::string checked(const deck::Deck& deck) {
  const std::string text = steps::check(deck);
  if (first_bad_byte(text) != std::string::npos) throw std::logic_error("control characters on stdout");
  return "done";
}

/// What stands in the tables of a run that is done must be numbers.
std::string fault_of_tables(const std::string& directory) {
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().extension() != ".csv") continue;
    const std::string text = read(entry.path());
    for (const char* word : {",nan", ",-nan", ",inf", ",-inf"})
      if (text.find(word) != std::string::npos)
        return fmt::format("no number: {} holds \"{}\"", entry.path().filename().string(), word);
  }
  return {};
}

/// Files outside the directory of the run.
std::string fault_of_files(const std::string& around) {
  for (const auto& entry : fs::directory_iterator(around))
    if (entry.path().filename() != "results") return "file outside: " + entry.path().string();
  return {};
}

Answer run_and_look(const deck::Deck& deck, const std::string& around) {
  Progress silent;
  const std::string directory = around + "/results";
  const ExitCode code = steps::run(deck, {directory, false, ""}, silent);
  Answer answer{code == ExitCode::done ? "done" : "not converged", fault_of_files(around), {}};
  if (code == ExitCode::done && answer.fault.empty()) answer.fault = fault_of_tables(directory);
  return answer;
}

Campaign decks(const Places& places) {
  auto mutator = std::make_shared<DeckMutator>(read_seeds(
      {places.source + "/inputs", places.source + "/tests/decks/good", places.source + "/verification"},
      12'000));
  return {"decks", ".yaml",
          [mutator](std::uint64_t seed) {
            Random random(seed, "decks");
            auto mutant = mutator->make(random);
            return Input{std::move(mutant.text), mutant.seed->path};
          },
          [](const Input& input) {
            const std::string name = name_beside(input.origin);
            return guarded(name, input.text, [&] { return checked(deck::parse_deck(input.text, name)); });
          }};
}

Campaign runs(const Places& places) {
  auto mutator = std::make_shared<DeckMutator>(
      read_seeds({places.source + "/verification", places.source + "/tests/system/decks"}, 900));
  const std::string around = places.work + "/runs";
  return {"runs", ".yaml",
          [mutator](std::uint64_t seed) {
            Random random(seed, "runs");
            auto mutant = mutator->make(random);
            return Input{std::move(mutant.text), mutant.seed->path};
          },
          [around](const Input& input) {
            const std::string name = name_beside(input.origin);
            fs::remove_all(around);
            fs::create_directories(around);
            Answer looked;
            Answer answer = guarded(name, input.text, [&] {
              looked = run_and_look(deck::parse_deck(input.text, name), around);
              return looked.end;
            });
            if (answer.fault.empty()) answer.fault = looked.fault;
            return answer;
          }};
}

Campaign meshes(const Places& places) {
  auto mutator = std::make_shared<MeshMutator>(places.source + "/tests/fuzz/corpus/meshes");
  const std::string file = places.work + "/mutant.msh";
  return {"meshes", ".msh",
          [mutator](std::uint64_t seed) {
            Random random(seed, "meshes");
            return mutator->make(random);
          },
          [file](const Input& input) {
            const std::string deck = read(input.origin), name = name_beside(input.origin);
            write(file, input.text);
            return guarded(name, deck,
                           [&] { return checked(deck::parse_deck(deck, name, {"model.mesh=" + file})); });
          }};
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (c == '\n')
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

Campaign overrides(const Places& places) {
  auto mutator = std::make_shared<DeckMutator>(
      read_seeds({places.source + "/inputs", places.source + "/tests/decks/good"}, 12'000));
  return {"overrides", ".txt",
          [mutator](std::uint64_t seed) {
            Random random(seed, "overrides");
            const auto& deck = random.one_of(mutator->seeds());
            return Input{some_overrides(deck.tree, random), deck.path};
          },
          [](const Input& input) {
            const std::string deck = read(input.origin), name = name_beside(input.origin);
            return guarded(name, deck,
                           [&] { return checked(deck::parse_deck(deck, name, lines(input.text))); });
          }};
}

Campaign reports(const Places& places) {
  auto originals = std::make_shared<std::vector<std::string>>();
  for (const auto& entry : fs::directory_iterator(places.source + "/tests/fuzz/corpus/results"))
    originals->push_back(entry.path().string());
  std::sort(originals->begin(), originals->end());
  const std::string directory = places.work + "/report";
  return {"reports", ".json",
          [originals](std::uint64_t seed) {
            Random random(seed, "reports");
            const std::string& origin = random.one_of(*originals);
            return Input{damaged_results(read(origin), random), origin};
          },
          [directory](const Input& input) {
            fs::create_directories(directory);
            write(directory + "/results.json", input.text);
            return guarded(directory, input.text, [&] {
              output::write_report({directory});
              output::comparison_text({directory, directory});
              return std::string("done");
            });
          }};
}

}  // namespace

std::string fault_of_message(const std::string& message) {
  if (message.find_first_not_of(" \n") == std::string::npos) return "no words: the message is empty";
  if (message.size() > 200'000) return fmt::format("many words: {} bytes", message.size());
  const std::size_t bad = first_bad_byte(message);
  if (bad != std::string::npos)
    return fmt::format("control character: 0x{:02x} in the message",
                       static_cast<unsigned char>(message[bad]));
  return {};
}

std::string fault_of(const DeckError& error, const std::string& file, const std::string& text) {
  const std::vector<std::string> all = lines(text);
  if (error.diagnostics().empty()) return "no words: no diagnostics";
  for (const auto& diagnostic : error.diagnostics()) {
    const auto& where = diagnostic.where;
    if (where.file != file) {
      if (where.file.rfind("--set ", 0) != 0) return "wrong place: file " + where.file;
      continue;
    }
    const bool of_all = where.line == 0 && where.column == 0;
    if (of_all) continue;
    if (where.line < 1 || where.line > static_cast<int>(all.size()))
      return fmt::format("wrong place: line {} of {}", where.line, all.size());
    const auto& line = all[static_cast<std::size_t>(where.line) - 1];
    if (where.column < 1 || where.column > characters(line, line.size()) + 1)
      return fmt::format("wrong place: column {} of {}", where.column, characters(line, line.size()));
  }
  return fault_of_message(error.what());
}

std::vector<Campaign> campaigns(const Places& places) {
  return {decks(places), runs(places), meshes(places), overrides(places), reports(places)};
}

}  // namespace tautline::fuzz
