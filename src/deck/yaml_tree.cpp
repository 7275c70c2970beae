#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <deck/yaml_fault.hpp>
#include <deck/yaml_tree.hpp>
#include <map>
#include <sstream>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

constexpr std::size_t most_nodes = 1'000'000;  ///< a guard against anchors that multiply each other

std::size_t count(const Node& node) {
  std::size_t total = 1;
  for (const auto& item : node.items) total += count(item);
  for (const auto& entry : node.entries) total += count(entry.value);
  return total;
}

void set_note(Node& node, const std::string& note) {
  node.note = note;
  for (auto& item : node.items) set_note(item, note);
  for (auto& entry : node.entries) set_note(entry.value, note);
}

/// Builds the tree from the library's events.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const Source& source) : source_(source) {}

  Node take() { return std::move(root_); }
  bool started() const { return n_documents_ > 0; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++n_documents_ > 1) reject(place(mark, 3), "a second document begins here", "a deck is one document");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    Node node;
    node.place = place(mark, 1);
    if (in_key_position()) reject(node.place, "a key is missing before \":\"");
    node.place = open_.empty() ? node.place : open_.back().pending.place;
    if (!open_.empty() && open_.back().node.is_sequence()) node.place = open_.back().node.place;
    add(std::move(node));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) reject(place(mark, 1), "this alias stands inside its own anchor");
    n_nodes_ += count(found->second);
    if (n_nodes_ > most_nodes) reject(place(mark, 1), "aliases make the deck too large");
    Node node = found->second;
    set_note(node, fmt::format("the value comes from the anchor in line {}", node.place.line));
    node.place = place(mark, word_length(mark));
    if (in_key_position()) reject(node.place, "an alias cannot be a key");
    add(std::move(node));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    reject_tag(mark, tag);
    const YAML::Mark begin = after_anchor(mark);
    if (first_bad_byte(value) != std::string::npos)
      reject(place(begin, 1), "this text holds a control character, written as an escape");
    Node node;
    node.kind = Node::Kind::scalar;
    node.text = value;
    node.quoted = tag == "!";
    const char first = character(begin);
    const bool in_quotes = node.quoted && (first == '"' || first == '\'');
    if (in_quotes) reject_open_quote(source_, begin.line, begin.column);
    node.place = place(begin, value.size() + (in_quotes ? 2 : 0));
    if (in_key_position()) {
      open_.back().pending = {value, node.place, {}};
      open_.back().has_key = true;
      return;
    }
    remember(anchor, node);
    add(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, tag, anchor, Node::Kind::sequence);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, tag, anchor, Node::Kind::mapping);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    Entry pending;  ///< mappings: the key that waits for its value
    bool has_key = false;
  };

  bool in_key_position() const {
    return !open_.empty() && open_.back().node.is_mapping() && !open_.back().has_key;
  }
  Place place(const YAML::Mark& mark, std::size_t bytes) const {
    return source_.place(mark.line, mark.column, bytes);
  }
  char character(const YAML::Mark& mark) const {
    const std::string& line = source_.line(mark.line + 1);
    return mark.column < static_cast<int>(line.size()) ? line[static_cast<std::size_t>(mark.column)] : '\n';
  }
  std::size_t word_length(const YAML::Mark& mark) const {
    const std::string& line = source_.line(mark.line + 1);
    const auto end = line.find_first_of(" ,]}\t", static_cast<std::size_t>(mark.column));
    return (end == std::string::npos ? line.size() : end) - static_cast<std::size_t>(mark.column);
  }
  /// The mark moved past "&name ".
  YAML::Mark after_anchor(YAML::Mark mark) const {
    const std::string& line = source_.line(mark.line + 1);
    if (character(mark) != '&') return mark;
    const auto value =
        line.find_first_not_of(" \t", static_cast<std::size_t>(mark.column) + word_length(mark));
    if (value != std::string::npos) mark.column = static_cast<int>(value);
    return mark;
  }
  void reject_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.size() > 1) reject(place(mark, word_length(mark)), "a deck uses no YAML tags");
  }

  void begin(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, Node::Kind kind) {
    reject_tag(mark, tag);
    if (in_key_position()) reject(place(mark, 1), "a key must be a single word");
    Open open;
    open.node.kind = kind;
    open.node.place = place(after_anchor(mark), 1);
    open.anchor = anchor;
    open_.push_back(std::move(open));
  }
  void end() {
    Open closed = std::move(open_.back());
    open_.pop_back();
    remember(closed.anchor, closed.node);
    add(std::move(closed.node));
  }
  void remember(YAML::anchor_t anchor, const Node& node) {
    if (anchor != 0) anchors_[anchor] = node;
  }
  void add(Node node) {
    if (++n_nodes_ > most_nodes)
      reject(node.place, fmt::format("the deck is too large: it holds more than {} values", most_nodes),
             "describe large structures by a mesh file");
    node.label = node.place;
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.is_sequence()) {
      open_.back().node.items.push_back(std::move(node));
    } else {
      Open& mapping = open_.back();
      node.label = mapping.pending.place;
      mapping.pending.value = std::move(node);
      mapping.node.entries.push_back(std::move(mapping.pending));
      mapping.has_key = false;
    }
  }

  const Source& source_;
  Node root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchors_;
  std::size_t n_nodes_ = 0;
  int n_documents_ = 0;
};

[[noreturn]] void fail(const Source& source, const Place& place, const std::string& message,
                       const std::string& remedy) {
  Diagnostic diagnostic = source.diagnostic(place, message);
  diagnostic.suggestion = remedy;
  throw DeckError({diagnostic});
}

void reject_bytes(const Source& source, const std::string& text) {
  const std::size_t bad = first_bad_byte(text);
  if (bad == std::string::npos) return;
  const auto byte = static_cast<unsigned char>(text[bad]);
  const auto line_begin = text.rfind('\n', bad == 0 ? 0 : bad - 1);
  const auto line =
      static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n'));
  Diagnostic diagnostic;
  diagnostic.where = {source.name(), line + 1, static_cast<int>(line == 0 ? bad : bad - line_begin - 1) + 1};
  diagnostic.message =
      byte < 0x80U ? fmt::format("this is no text file: it holds the control character 0x{:02X}", byte)
                   : fmt::format("this is no text file in UTF-8: it holds the byte 0x{:02X}", byte);
  diagnostic.suggestion = "save the deck as plain text in UTF-8";
  throw DeckError({diagnostic});
}

void reject_top(const Source& source, const Node& root, bool started) {
  if (root.is_mapping()) return;
  const bool empty = !started || root.kind == Node::Kind::empty;
  if (empty)
    fail(source, Place(), "the deck is empty",
         "\"tautline new perimeter-truss\" prints a deck to start from");
  fail(source, root.place, fmt::format("a deck is a mapping (key: value), but this is {}", root.describe()),
       "");
}

}  // namespace

Node parse_yaml(const Source& source, const std::string& text) {
  reject_bytes(source, text);
  TreeBuilder builder(source);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    const YamlFault fault = explain_syntax(source, error.mark.line, error.mark.column, error.msg);
    fail(source, fault.place, fault.message, fault.remedy);
  } catch (const YamlFault& fault) {
    fail(source, fault.place, fault.message, fault.remedy);
  }
  Node root = builder.take();
  reject_top(source, root, builder.started());
  return root;
}

}  // namespace tautline::deck
