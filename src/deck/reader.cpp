#include <fmt/format.h>

#include <algorithm>
#include <deck/reader.hpp>
#include <map>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

std::string quoted_list(const std::vector<std::string>& words) {
  return fmt::format("\"{}\"", join(words, "\", \""));
}

}  // namespace

std::string label_of(const Node& node) {
  for (const char* key : {"name", "kind"})
    if (const Node* name = node.find(key); name != nullptr && name->is_scalar()) return name->text;
  return {};
}

Reader::Step::Step(Reader& reader, std::string name, std::string label) : reader_(reader) {
  reader_.path_.emplace_back(std::move(name), std::move(label));
}
Reader::Step::~Step() {
  reader_.path_.pop_back();
}

std::string context_text(const std::vector<std::string>& path) {
  return path.empty() ? "at the top level" : "in " + join(path, ".", path.size());
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? std::string() : fmt::format("did you mean \"{}\"?", near);
}

std::string Reader::context() const {
  std::vector<std::string> words;
  std::string label;
  for (const auto& [name, called] : path_) {
    words.push_back(name);
    if (!called.empty()) label = fmt::format(" (\"{}\")", called);
  }
  return context_text(words) + label;
}

void Reader::complain(const Node& node, std::string message, std::string expectation,
                      std::string suggestion) {
  if (node.kind == Node::Kind::broken) return;
  if (!node.note.empty()) suggestion += (suggestion.empty() ? "" : "; ") + node.note;
  complain(node.place, std::move(message), context(), std::move(expectation), std::move(suggestion));
}

void Reader::complain(const Place& place, std::string message, std::string context, std::string expectation,
                      std::string suggestion) {
  if (complaints_.is_full()) return complaints_.count_one();
  Diagnostic diagnostic = source_.diagnostic(place, std::move(message));
  diagnostic.context = std::move(context);
  diagnostic.expectation = std::move(expectation);
  diagnostic.suggestion = std::move(suggestion);
  complaints_.add(std::move(diagnostic));
}

void Reader::read_block(const BlockSet& set, Node& node, void* owner) {
  if (!node.is_mapping()) {
    complain(node, fmt::format("a block is expected here, but this is {}", node.describe()),
             "expected keys with values");
    return;
  }
  const Block* block = choose(set, node);
  if (block == nullptr) return;
  block->begin(owner);
  if (block->place) block->place(owner, source_.where(node.label));
  check_keys(*block, node);
  check_missing(*block, node);
  std::set<std::string_view> seen;
  for (auto& entry : node.entries) {
    const Keyword* keyword = block->find(entry.key);
    if (keyword == nullptr || !seen.insert(entry.key).second) continue;
    used_.insert(keyword);
    if (entry.value.kind == Node::Kind::empty)
      complain(entry.value, fmt::format("\"{}\" has no value", entry.key),
               "expected " + keyword->expectation());
    else
      keyword->read(*this, *keyword, entry.value, owner);
  }
  if (block->check) block->check(*this, node, owner);
}

const Block* Reader::choose(const BlockSet& set, const Node& node) {
  if (!set.has_kind()) return &set.alternatives.front();
  const Node* kind = node.find("kind");
  const std::string known = "expected one of: " + join(set.kinds());
  if (kind == nullptr || !kind->is_scalar()) {
    check_duplicates(node);
    if (kind == nullptr)
      complain(node.label, "missing key \"kind\"", context(), known);
    else
      complain(*kind, fmt::format("\"kind\" is {}", kind->describe()), known);
    return nullptr;
  }
  if (const Block* block = set.find(kind->text)) return block;
  check_duplicates(node);
  if (std::find(set.planned.begin(), set.planned.end(), kind->text) != set.planned.end())
    complain(*kind, fmt::format("kind \"{}\" is not available in this version", kind->text),
             "available: " + join(set.kinds()));
  else
    complain(*kind, fmt::format("unknown kind \"{}\"", kind->text), known,
             did_you_mean(kind->text, set.kinds()));
  return nullptr;
}

void Reader::check_duplicates(const Node& node) {
  std::map<std::string_view, int> line_of;
  for (const auto& entry : node.entries) {
    const auto [first, is_new] = line_of.emplace(entry.key, entry.place.line);
    if (is_new) continue;
    complain(entry.place, fmt::format("duplicate key \"{}\"", entry.key), context(), {},
             fmt::format("first given in line {}", first->second));
  }
}

void Reader::check_keys(const Block& block, Node& node) {
  check_duplicates(node);
  std::set<std::string> seen;
  for (auto& entry : node.entries) {
    const bool is_kind = entry.key == "kind" && !block.kind.empty();
    if (is_kind || block.find(entry.key) != nullptr || !seen.insert(entry.key).second) continue;
    const std::string guess = unknown_key(block, entry);
    if (!guess.empty() && node.find(guess) == nullptr) entry.key = guess;
  }
}

/// Complains, and returns the key that is most likely meant, or "".
std::string Reader::unknown_key(const Block& block, const Entry& entry) {
  const std::string message = fmt::format("unknown key \"{}\"", entry.key);
  const auto remedy = [&](const std::string& text) { complain(entry.place, message, context(), {}, text); };
  for (const auto& keyword : block.keywords) {
    const auto& others = keyword.other_names;
    if (std::find(others.begin(), others.end(), entry.key) == others.end()) continue;
    remedy(fmt::format("it is called \"{}\"", keyword.name));
    return keyword.name;
  }
  if (const std::string near = nearest(entry.key, block.names()); !near.empty()) {
    remedy(did_you_mean(entry.key, block.names()));
    return near;
  }
  const auto homes = homes_of(entry.key, &block);
  if (entry.key == "<<")
    remedy("merge keys (\"<<\") are not read; write the keys out");
  else if (!homes.empty())
    remedy(fmt::format("it belongs to {}", join(homes, " or ", 6)));
  else
    complain(entry.place, message, context(), "expected one of: " + join(block.names()));
  return {};
}

void Reader::check_missing(const Block& block, const Node& node) {
  std::vector<std::string> missing, expected;
  for (const auto& keyword : block.keywords) {
    if (!keyword.is_required || node.find(keyword.name) != nullptr) continue;
    if (keyword.spared && keyword.spared(node)) continue;
    missing.push_back(keyword.name);
    expected.push_back(fmt::format("{}: {}", keyword.name, keyword.expectation()));
  }
  if (missing.empty()) return;
  complain(path_.empty() ? Place() : node.label,
           fmt::format("missing key{} {}", missing.size() > 1 ? "s" : "", quoted_list(missing)), context(),
           "expected " + join(expected, "; "));
}

}  // namespace tautline::deck
