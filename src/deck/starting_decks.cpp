#include <fmt/format.h>

#include <array>
#include <deck/reader.hpp>
#include <deck/starting_decks.hpp>
#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>
#include <utility>

namespace tautline::deck {

namespace {

const std::array<std::pair<const char*, const char*>, 6>& table() {
  static const std::array<std::pair<const char*, const char*>, 6> decks{
      {{"perimeter-truss", starting_perimeter_truss},
       {"umbrella", starting_umbrella},
       {"net", starting_net},
       {"membrane", starting_membrane},
       {"frame", starting_frame},
       {"rod-umbrella", starting_rod_umbrella}}};
  return decks;
}

}  // namespace

std::vector<std::string> starting_deck_kinds() {
  std::vector<std::string> kinds;
  for (const auto& [kind, text] : table()) kinds.emplace_back(kind);
  return kinds;
}

std::string starting_deck(const std::string& kind) {
  for (const auto& [name, text] : table())
    if (name == kind) return text;
  Diagnostic diagnostic;
  diagnostic.where.file = "new";
  diagnostic.message = fmt::format("unknown kind \"{}\"", kind);
  diagnostic.expectation = fmt::format("expected one of: {}", join(starting_deck_kinds()));
  diagnostic.suggestion = did_you_mean(kind, starting_deck_kinds());
  throw DeckError({diagnostic});
}

}  // namespace tautline::deck
