#include <fmt/format.h>

#include <algorithm>
#include <deck/source.hpp>
#include <tautline/core/text.hpp>
#include <tuple>

namespace tautline::deck {

namespace {

constexpr std::size_t most_shown = 20;
constexpr std::size_t most_kept = 50'000'000;  // bytes

}  // namespace

Source::Source(std::string name, const std::string& text) : name_(std::move(name)) {
  std::string current;
  for (const char c : text) {
    if (c == '\n') {
      lines_.push_back(std::move(current));
      current.clear();
    } else if (c != '\r') {
      current += c;
    }
  }
  if (!current.empty()) lines_.push_back(std::move(current));
}

const std::string& Source::line(int number) const {
  static const std::string none;
  return number >= 1 && number <= n_lines() ? lines_[static_cast<std::size_t>(number) - 1] : none;
}

Place Source::place(int line_from_0, int byte_column, std::size_t bytes) const {
  const std::string& text = line(line_from_0 + 1);
  const auto begin = std::min(static_cast<std::size_t>(std::max(0, byte_column)), text.size());
  const auto end = std::min(begin + bytes, text.size());
  const int before = characters_before(line_from_0 + 1, begin);
  const int length = characters(std::string_view(text).substr(begin, end - begin), end - begin);
  return {line_from_0 + 1, before + 1, std::max(1, length), {}};
}

int Source::characters_before(int number, std::size_t bytes) const {
  if (counted_.line != number || counted_.bytes > bytes) counted_ = {number, 0, 0};
  const std::string_view rest = std::string_view(line(number)).substr(counted_.bytes);
  counted_.characters += characters(rest, bytes - counted_.bytes);
  counted_.bytes = bytes;
  return counted_.characters;
}

SourceLocation Source::where(const Place& place) const {
  if (!place.origin.empty()) return {place.origin, 0, 0};
  return {name_, place.line, place.column};
}

Diagnostic Source::diagnostic(const Place& place, std::string message) const {
  Diagnostic result;
  result.where = where(place);
  result.message = std::move(message);
  if (place.origin.empty() && place.line > 0) {
    result.source_line = line(place.line);
    std::replace(result.source_line.begin(), result.source_line.end(), '\t', ' ');
    const int width = characters(result.source_line, result.source_line.size());
    result.length = std::max(1, std::min(place.length, width - place.column + 1));
  }
  return result;
}

bool Complaints::is_full() const noexcept {
  return bytes_ > most_kept;
}

void Complaints::add(Diagnostic diagnostic) {
  if (is_full()) {
    ++n_more_;
    return;
  }
  std::string text = to_string(diagnostic);
  bytes_ += text.size() + diagnostic.source_line.size();
  if (seen_.insert(std::move(text)).second) list_.push_back(std::move(diagnostic));
}

void Complaints::throw_if_any() {
  if (list_.empty()) return;
  const auto earlier = [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.where.line, a.where.column) < std::tie(b.where.line, b.where.column);
  };
  std::stable_sort(list_.begin(), list_.end(), earlier);
  if (list_.size() > most_shown) {
    Diagnostic rest;
    rest.where.file = list_.back().where.file;
    rest.message =
        fmt::format("{} errors in all; the first {} are shown", list_.size() + n_more_, most_shown);
    list_.resize(most_shown);
    list_.push_back(std::move(rest));
  }
  throw DeckError(list_);
}

}  // namespace tautline::deck
