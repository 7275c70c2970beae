#pragma once
/// @file
/// SHA-256 (FIPS 180-4), for the fingerprints of decks and files.

#include <string>
#include <string_view>

namespace tautline {

/// Digest of the bytes in lower-case hex.
std::string sha256(std::string_view bytes);

}  // namespace tautline
