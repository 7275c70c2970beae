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

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  if (word.size() <= 2) return {};
  const std::string wanted = normalised(word);
  std::size_t best = 2 + word.size() / 5;
  std::string result;
  for (const auto& candidate : candidates) {
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

int characters(std::string_view text, std::size_t bytes) {
  int count = 0;
  for (std::size_t i = 0; i < std::min(bytes, text.size()); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) ++count;
  return count;
}

}  // namespace tautline
