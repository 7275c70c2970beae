#include <fmt/format.h>

#include <array>
#include <deck/yaml_fault.hpp>
#include <optional>

namespace tautline::deck {

namespace {

struct Bracket {
  char symbol;
  int line;
  int column;
};

/// Follows quotes, comments and brackets through the text; good enough to find what was left open.
class BracketScan {
 public:
  /// The bracket that is closed by one of the other sort, or else the first that is never closed.
  std::optional<Bracket> unclosed(const Source& source) {
    for (int number = 0; number < source.n_lines() && !crossed_; ++number)
      scan_line(source.line(number + 1), number);
    if (open_.empty()) return {};
    return crossed_ ? open_.back() : open_.front();
  }

 private:
  void scan_line(const std::string& line, int number) {
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (quote != 0) {
        if (c == '\\' && quote == '"') ++i;
        if (c == quote) quote = 0;
      } else if (c == '#' && (i == 0 || line[i - 1] == ' ')) {
        return;
      } else if ((c == '"' || c == '\'') && at_value(line, i)) {
        quote = c;
      } else if ((c == '[' || c == '{') && (!open_.empty() || at_value(line, i))) {
        open_.push_back({c, number, static_cast<int>(i)});
      } else if ((c == ']' || c == '}') && !open_.empty()) {
        crossed_ = (c == ']') != (open_.back().symbol == '[');
        if (crossed_) return;
        open_.pop_back();
      }
    }
  }
  static bool at_value(const std::string& line, std::size_t i) {
    const auto before = line.find_last_not_of(" \t", i == 0 ? std::string::npos : i - 1);
    return i == 0 || before == std::string::npos ||
           std::string("[{,:-").find(line[before]) != std::string::npos;
  }

  std::vector<Bracket> open_;
  bool crossed_ = false;
};

bool has_leading_tab(const std::string& line) {
  const auto first = line.find_first_not_of(' ');
  return first != std::string::npos && line[first] == '\t';
}

/// A parameter without quotes inside brackets, e.g. {width: ${w}}.
bool has_bare_parameter(const std::string& line, int column) {
  const auto bracket = line.find_first_of("[{");
  const auto dollar = line.find("${");
  return dollar != std::string::npos && bracket < dollar && static_cast<int>(dollar) <= column &&
         (dollar == 0 || (line[dollar - 1] != '"' && line[dollar - 1] != '\''));
}

struct Translation {
  const char* theirs;
  const char* message;
  const char* remedy;
};

Translation translated(const std::string& complaint) {
  static const std::array<Translation, 8> table{{
      {"illegal map value", "a \":\" where no key can stand",
       "text that holds \": \" needs quotes; keys of one block need the same indentation"},
      {"end of map not found", "this line does not fit the mapping it stands in", "check the indentation"},
      {"end of sequence not found", "this line does not fit the list it stands in",
       "check the indentation and the \"-\""},
      {"illegal block entry", "a list (\"-\") cannot begin here", ""},
      {"the referenced anchor is not defined", "an alias without its anchor",
       "\"&name\" must stand before \"*name\""},
      {"unknown token", "no text can begin with this character", "put the text in quotes"},
      {"unknown escape character", "an unknown escape", "a backslash in double quotes is written \"\\\\\""},
      {"illegal flow end", "a closing bracket without its opening one", ""},
  }};
  for (const auto& entry : table)
    if (complaint.rfind(entry.theirs, 0) == 0) return entry;
  return {"", complaint.c_str(), ""};
}

}  // namespace

void reject(const Place& place, const std::string& message, const std::string& remedy) {
  throw YamlFault{place, message, remedy};
}

YamlFault explain_syntax(const Source& source, int line, int column, const std::string& complaint) {
  const std::string& text = source.line(line + 1);
  if (has_leading_tab(text))
    return {source.place(line, static_cast<int>(text.find('\t')), 1), "a tab in the indentation",
            "use spaces"};
  if (has_bare_parameter(text, column))
    return {source.place(line, static_cast<int>(text.find("${")), 2),
            "a parameter inside [ ] or { } needs quotes", "write \"${name}\""};
  if (complaint.find("flow") != std::string::npos || line >= source.n_lines()) {
    if (const auto open = BracketScan().unclosed(source))
      return {source.place(open->line, open->column, 1),
              fmt::format("this \"{}\" is not closed", open->symbol),
              fmt::format("reading stopped near line {}", std::min(line + 1, source.n_lines()))};
  }
  const auto [theirs, message, remedy] = translated(complaint);
  return {source.place(line, column, 1), fmt::format("no valid YAML near here: {}", message), remedy};
}

void reject_open_quote(const Source& source, int line, int column) {
  const char quote = source.line(line + 1)[static_cast<std::size_t>(column)];
  const std::string& text = source.line(line + 1);
  for (auto i = static_cast<std::size_t>(column) + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote != '\'' || i + 1 >= text.size() || text[i + 1] != '\'') return;
      ++i;
    }
  }
  reject(source.place(line, column, 1), "this quote is not closed in its line");
}

}  // namespace tautline::deck
