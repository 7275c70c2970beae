#include <tautline/core/text.hpp>

#include <algorithm>
#include <cctype>
#include <numeric>

#include <fmt/format.h>

namespace tautline {

namespace {

std::string normalised(std::string_view word) {
  std::string result;
  for (const char c : word)
    result += (c == '-') ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::size_t levenshtein(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row[b.size()];
}

/// Number of continuation bytes after a leading byte, or -1.
int continuation_bytes(unsigned char lead) {
  if (lead < 0x80U) return 0;
  if (lead >= 0xC2U && lead < 0xE0U) return 1;
  if (lead >= 0xE0U && lead < 0xF0U) return 2;
  if (lead >= 0xF0U && lead < 0xF5U) return 3;
  return -1;
}

bool is_control(unsigned char c) {
  return (c < 0x20U && c != '\n' && c != '\r' && c != '\t') || c == 0x7FU;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() <= 2) return {};
  const std::string wanted = normalised(word);
  std::size_t best = 2 + word.size() / 5;
  std::string result;
  for (const auto& candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), wanted.size());
    if (longer - std::min(candidate.size(), wanted.size()) >= best) continue;
    const std::size_t distance = levenshtein(wanted, normalised(candidate));
    if (distance < best) {
      best = distance;
      result = candidate;
    }
  }
  return result;
}

std::string join(const std::vector<std::string>& words, std::string_view separator, std::size_t most) {
  std::string result;
  for (std::size_t i = 0; i < words.size() && i < most; ++i) {
    if (i > 0) result += separator;
    result += words[i];
  }
  if (words.size() > most) result += fmt::format("{}... ({} in all)", separator, words.size());
  return result;
}

std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

int characters(std::string_view text, std::size_t bytes) {
  int count = 0;
  for (std::size_t i = 0; i < std::min(bytes, text.size()); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) ++count;
  return count;
}

std::size_t first_bad_byte(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int more = continuation_bytes(lead);
    if (more < 0 || is_control(lead)) return i;
    if (lead == 0xC2U && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0U)
      return i;  // control characters of ISO 6429
    for (int k = 1; k <= more; ++k) {
      if (i + k >= text.size() || (static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return i;
    }
    i += static_cast<std::size_t>(more);
  }
  return std::string_view::npos;
}

std::string printable(std::string_view text) {
  std::string result;
  for (auto bad = first_bad_byte(text); bad != std::string_view::npos; bad = first_bad_byte(text)) {
    result += fmt::format("{}\\x{:02X}", text.substr(0, bad), static_cast<unsigned char>(text[bad]));
    text.remove_prefix(bad + 1);
  }
  return result.append(text);
}

}  // namespace tautline
