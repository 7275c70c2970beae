#include <charconv>
#include <deck/node.hpp>
#include <utility>

namespace tautline::deck {

const Node* Node::find(std::string_view key) const {
  for (const auto& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

Node* Node::find(std::string_view key) {
  return const_cast<Node*>(std::as_const(*this).find(key));
}

const Node* Node::at(const std::vector<std::string>& path) const {
  const Node* node = this;
  for (const auto& step : path) {
    if (node->is_sequence()) {
      const int index = list_index(step);
      node = index >= 0 && index < static_cast<int>(node->items.size()) ? &node->items[index] : nullptr;
    } else {
      node = node->find(step);
    }
    if (node == nullptr) return nullptr;
  }
  return node;
}

std::string Node::describe() const {
  switch (kind) {
    case Kind::empty:
    case Kind::broken:
      return "empty";
    case Kind::scalar:
      return "a single value";
    case Kind::sequence:
      return "a list";
    case Kind::mapping:
      return "a mapping";
  }
  return {};
}

int list_index(std::string_view text) {
  int value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 ? value : -1;
}

}  // namespace tautline::deck
