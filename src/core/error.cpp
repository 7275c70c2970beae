#include <tautline/core/error.hpp>

#include <fmt/format.h>

#include <tautline/core/text.hpp>

namespace tautline {

namespace {

std::string place(const SourceLocation& where) {
  if (where.line == 0) return where.file;
  return fmt::format("{}:{}:{}", where.file, where.line, where.column);
}

std::string summary(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const auto& diagnostic : diagnostics) text += to_string(diagnostic);
  return text;
}

}  // namespace

std::string to_string(const Diagnostic& d) {
  std::string text = fmt::format("{}: error: {}\n", place(d.where), d.message);
  if (!d.source_line.empty()) {
    const std::string number = std::to_string(d.where.line);
    text += fmt::format("{:>5} | {}\n", number, d.source_line);
    text += fmt::format("{:>5} | {}^{}\n", "", std::string(std::max(0, d.where.column - 1), ' '),
                        std::string(std::max(0, d.length - 1), '~'));
  }
  std::string detail = d.context;
  if (!d.expectation.empty()) detail += (detail.empty() ? "" : "; ") + d.expectation;
  if (!detail.empty()) text += "  " + detail + "\n";
  if (!d.suggestion.empty()) text += "  " + d.suggestion + "\n";
  return text;
}

DeckError::DeckError(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(summary(diagnostics)), diagnostics_(std::move(diagnostics)) {}

std::string with_context(const std::string& error, const std::string& doing) {
  return fmt::format("{}\n  while {}", error, doing);
}

}  // namespace tautline
