#include <fmt/format.h>

#include <deck/topics.hpp>
#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

constexpr const char* notice =
    "<!-- Made from the keyword table (src/deck/keywords_*.cpp); see docs/deck/README.md. -->\n\n";

/// Table cells cannot hold a bar.
std::string cell(std::string text) {
  for (auto at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.replace(at, 1, "\\|");
  return text;
}

std::string key_table(const Block& block) {
  std::string text = "| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n";
  if (!block.kind.empty())
    text += fmt::format("| `kind` | word | - | required | {} | Chooses this block. |\n", block.kind);
  for (const auto& keyword : block.keywords) {
    const std::string fallback = default_text(keyword);
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", keyword.name, cell(type_text(keyword)),
                        keyword.unit, fallback.empty() ? "-" : cell(fallback), cell(range_text(keyword)),
                        cell(keyword.sentence));
  }
  return text;
}

std::string block_text(const Block& block, const std::string& mark) {
  std::string text = block.sentence + "\n\n" + key_table(block);
  for (const auto& keyword : block.keywords) {
    if (keyword.blocks == nullptr || block.path.empty()) continue;
    for (const auto& inner : keyword.blocks->alternatives)
      text += fmt::format("\n{}# `{}`\n\n", mark, keyword.name) + block_text(inner, mark + "#");
  }
  return text;
}

std::string form(const Keyword& keyword) {
  if (keyword.shape == Shape::list) return fmt::format("```yaml\n{}:\n  - key: value\n```\n\n", keyword.name);
  if (keyword.shape == Shape::map)
    return fmt::format("```yaml\n{}:\n  name: {{key: value}}\n```\n\n", keyword.name);
  return fmt::format("```yaml\n{}:\n  key: value\n```\n\n", keyword.name);
}

std::string page(const Keyword& keyword) {
  const BlockSet& set = *keyword.blocks;
  std::string text =
      fmt::format("# `{}`\n\n{}{}\n\n{}", keyword.name, notice, keyword.sentence, form(keyword));
  for (const auto& block : set.alternatives) {
    if (set.has_kind()) text += fmt::format("## kind `{}`\n\n", block.kind);
    text += block_text(block, "##") + "\n";
  }
  if (!set.planned.empty()) text += fmt::format("Not available in this version: {}.\n", join(set.planned));
  while (text.size() > 1 && text[text.size() - 2] == '\n') text.pop_back();
  return text;
}

std::string index_page() {
  const Block& root = root_blocks().alternatives.front();
  std::string text = fmt::format("# The deck\n\n{}{}\n\n", notice, root.sentence);
  text +=
      "A deck is a YAML file, read strictly: an unknown, misspelt, duplicate or misplaced key is an error "
      "with its place and,\n"
      "where one is near, a suggestion. All values are in SI units, written without them. Numbers stand "
      "without quotes;\n"
      "`true` and `false` are the only booleans. `tautline explain KEY` prints what these pages say about a "
      "key,\n"
      "`tautline check DECK` tells everything that is wrong with a deck, `tautline schema` prints a JSON "
      "schema for editors.\n\n";
  text += key_table(root);
  text += "\nPages:\n\n";
  for (const auto& keyword : root.keywords)
    if (keyword.blocks != nullptr) text += fmt::format("- [{0}]({0}.md)\n", keyword.name);
  text +=
      "\n`--set path.to.key=value` changes one value from the command line: `--set parameters.s=8`, `--set "
      "reflector.gap=0.05`,\n"
      "`--set steps.1.subdivisions=8` (the first step is 0) or `--set steps.staged.reset=true` (a step by "
      "its name).\n\n"
      "These pages are compared with the table by the tests of the deck module; `TAUTLINE_UPDATE=1` in the "
      "environment of\n"
      "`test_deck` writes them anew.\n";
  return text;
}

}  // namespace

std::map<std::string, std::string> reference_pages() {
  std::map<std::string, std::string> pages{{"README.md", index_page()}};
  for (const auto& keyword : root_blocks().alternatives.front().keywords)
    if (keyword.blocks != nullptr) pages[keyword.name + ".md"] = page(keyword);
  return pages;
}

}  // namespace tautline::deck
