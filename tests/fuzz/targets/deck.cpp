/// @file
/// libFuzzer: any bytes are a deck or told to be none.

#include <cstdint>
#include <cstdlib>

#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tautline::deck::parse_deck({reinterpret_cast<const char*>(data), size}, "deck.yaml");
  } catch (const tautline::DeckError& error) {
    if (error.diagnostics().empty() || tautline::first_bad_byte(error.what()) != std::string::npos)
      std::abort();
  }
  return 0;
}
