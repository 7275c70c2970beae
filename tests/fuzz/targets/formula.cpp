/// @file
/// libFuzzer: any bytes are a formula, which then has a value, or told to be none.

#include <cstdint>
#include <stdexcept>

#include <tautline/core/expression.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    tautline::SpaceFormula formula(text);
    formula({0.5, -1, 2});
    formula.gradient({0, 0, 0});
  } catch (const std::invalid_argument&) {
  }
  try {
    tautline::Expression expression(text);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
