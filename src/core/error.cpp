#include <tautline/core/error.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/text.hpp>

namespace tautline {

namespace {

constexpr std::size_t longest = 2000;  // bytes of a sentence, which may hold names of any length

std::string place(const SourceLocation& where) {
  const std::string file = shortened(where.file, longest);
  if (where.line == 0) return file;
  return fmt::format("{}:{}:{}", file, where.line, where.column);
}

std::string summary(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const auto& diagnostic : diagnostics) text += to_string(diagnostic);
  return text;
}

/// Byte of the character number `index`, from 0; the end of the text beyond it.
std::size_t byte_of(const std::string& text, int index) {
  std::size_t byte = 0;
  for (; byte < text.size(); ++byte)
    if ((static_cast<unsigned char>(text[byte]) & 0xC0U) != 0x80U && index-- == 0) break;
  return byte;
}

/// The line with a mark below it; of a long one what stands about the mark.
std::string marked_line(const Diagnostic& d) {
  constexpr int widest = 160, before = 60;
  const int column = std::max(0, d.where.column - 1);
  const int width = characters(d.source_line, d.source_line.size());
  const int from = width <= widest ? 0 : std::max(0, column - before);
  const std::size_t begin = byte_of(d.source_line, from), end = byte_of(d.source_line, from + widest);
  const std::string left = from > 0 ? "..." : "", right = end < d.source_line.size() ? "..." : "";
  const int at = column - from + static_cast<int>(left.size());
  return fmt::format("{:>5} | {}{}{}\n{:>5} | {}^{}\n", std::to_string(d.where.line), left,
                     d.source_line.substr(begin, end - begin), right, "",
                     std::string(static_cast<std::size_t>(at), ' '),
                     std::string(static_cast<std::size_t>(std::clamp(d.length - 1, 0, widest - 1)), '~'));
}

}  // namespace

std::string to_string(const Diagnostic& d) {
  std::string text = fmt::format("{}: error: {}\n", place(d.where), shortened(d.message, longest));
  if (!d.source_line.empty()) text += marked_line(d);
  std::string detail = d.context;
  if (!d.expectation.empty()) detail += (detail.empty() ? "" : "; ") + d.expectation;
  if (!detail.empty()) text += "  " + shortened(detail, longest) + "\n";
  if (!d.suggestion.empty()) text += "  " + shortened(d.suggestion, longest) + "\n";
  return printable(text);
}

DeckError::DeckError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(summary(diagnostics)), diagnostics_(std::move(diagnostics)) {}

std::string with_context(const std::string& error, const std::string& doing) {
  return fmt::format("{}\n  while {}", error, doing);
}

}  // namespace tautline
