#include <fmt/format.h>

#include <algorithm>
#include <deck/reader.hpp>
#include <deck/topics.hpp>
#include <sstream>
#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

std::vector<std::string> words(const std::string& path) {
  std::vector<std::string> result;
  std::istringstream stream(path);
  for (std::string word; std::getline(stream, word, '.');) result.push_back(word);
  return result;
}

/// Whether all words of the question stand in the path, in order, and both end alike.
bool matches(const std::vector<std::string>& question, const std::vector<std::string>& path) {
  if (question.empty() || question.back() != path.back()) return false;
  std::size_t i = 0;
  for (const auto& word : path)
    if (i < question.size() && word == question[i]) ++i;
  return i == question.size();
}

std::string row(const std::string& name, const std::string& text) {
  return fmt::format("  {:<22} {}\n", name, text);
}

std::string heading(const Topic& topic) {
  if (topic.keyword == nullptr)
    return fmt::format("{} (kind: {})\n  {}\n", topic.path, topic.block->kind, topic.block->sentence);
  const Keyword& keyword = *topic.keyword;
  std::string text = fmt::format("{}: {}", topic.path, type_text(keyword));
  if (keyword.unit != "-") text += fmt::format(" [{}]", keyword.unit);
  return fmt::format("{}\n  {}\n", text, keyword.sentence);
}

std::string key_rows(const Block& block) {
  std::string text;
  for (const auto& keyword : block.keywords) {
    std::string meaning = keyword.sentence;
    if (keyword.unit != "-") meaning += fmt::format(" [{}]", keyword.unit);
    if (keyword.is_required) meaning += " (required)";
    text += row(keyword.name, meaning);
  }
  return text;
}

std::string kind_rows(const BlockSet& set) {
  if (!set.has_kind()) return key_rows(set.alternatives.front());
  std::string text;
  for (const auto& block : set.alternatives) text += row(fmt::format("kind: {}", block.kind), block.sentence);
  return text + fmt::format("Ask for {}.<kind> to see the keys of one.\n", set.path);
}

std::string full_text(const Topic& topic) {
  std::string text = heading(topic);
  if (topic.keyword == nullptr) return fmt::format("{}\n{}", text, key_rows(*topic.block));
  const Keyword& keyword = *topic.keyword;
  if (const auto range = range_text(keyword); !range.empty()) text += row("allowed", range);
  if (const auto fallback = default_text(keyword); !fallback.empty()) text += row("default", fallback);
  if (!keyword.other_names.empty()) text += row("also called", join(keyword.other_names));
  if (keyword.blocks != nullptr) text += fmt::format("\n{}", kind_rows(*keyword.blocks));
  return text;
}

std::string contents() {
  return fmt::format("Keys at the top of a deck:\n\n{}", key_rows(root_blocks().alternatives.front())) +
         "\nAsk for a key by its path (reflector.gap, steps.mesh.subdivisions) or by its last word (gap).\n";
}

[[noreturn]] void fail(const std::string& key, const std::vector<Topic>& topics) {
  std::vector<std::string> names;
  for (const auto& topic : topics) {
    names.push_back(topic.path);
    names.push_back(words(topic.path).back());
    names.push_back(words(topic.path).front() + "." + words(topic.path).back());
  }
  Diagnostic diagnostic;
  diagnostic.where.file = "explain";
  diagnostic.message = fmt::format("unknown key \"{}\"", key);
  diagnostic.suggestion = did_you_mean(key, names);
  if (diagnostic.suggestion.empty())
    diagnostic.suggestion = "\"tautline explain\" lists the keys at the top of a deck";
  throw DeckError({diagnostic});
}

}  // namespace

std::string explain(const std::string& key) {
  if (key.empty()) return contents();
  const auto topics = all_topics();
  std::vector<const Topic*> found;
  for (const auto& topic : topics) {
    if (topic.path == key) return full_text(topic);
    if (matches(words(key), words(topic.path))) found.push_back(&topic);
  }
  if (found.empty()) fail(key, topics);
  if (found.size() == 1) return full_text(*found.front());
  std::string text = fmt::format("\"{}\" stands for {} keys:\n\n", key, found.size());
  for (const Topic* topic : found) text += heading(*topic) + "\n";
  return text;
}

}  // namespace tautline::deck
