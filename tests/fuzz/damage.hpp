#pragma once
/// @file
/// Damage to any text or bytes, whatever they mean.

#include <string>

#include "random.hpp"

namespace tautline::fuzz {

using metamorphic::Random;

/// A few bytes, characters or lines changed, left out, repeated or moved.
void damage_text(std::string& text, Random& random);
/// The same without a notion of lines: bits, bytes, blocks, the end.
void damage_bytes(std::string& bytes, Random& random);

/// A number as someone might write it, of every size, some of them none.
std::string strange_number(Random& random);
/// A word as nobody should write it: long, empty, with control characters, markup, formulas, paths.
std::string strange_word(Random& random);

/// A place in a text, from 0 up to its end.
std::size_t place_in(const std::string& text, Random& random);

}  // namespace tautline::fuzz
