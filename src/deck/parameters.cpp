#include <fmt/format.h>

#include <deck/parameters.hpp>
#include <deck/reader.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

class Substitution {
 public:
  Substitution(const Node* parameters, const Source& source, Complaints& complaints)
      : parameters_(parameters), source_(source), complaints_(complaints) {
    if (parameters_ != nullptr)
      for (const auto& entry : parameters_->entries) names_.push_back(entry.key);
  }

  void walk(Node& node) {
    if (node.is_scalar()) replace(node);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      path_.push_back(std::to_string(i));
      walk(node.items[i]);
      path_.pop_back();
    }
    for (auto& entry : node.entries) {
      if (&entry.value == parameters_) continue;
      path_.push_back(entry.key);
      walk(entry.value);
      path_.pop_back();
    }
  }

 private:
  void replace(Node& node) {
    std::string result;
    std::size_t from = 0;
    for (auto begin = node.text.find("${"); begin != std::string::npos; begin = node.text.find("${", from)) {
      const auto end = node.text.find('}', begin);
      if (end == std::string::npos) return fail(node, "\"${\" without \"}\"", {}, {});
      const std::string name = node.text.substr(begin + 2, end - begin - 2);
      const Node* value = parameters_ != nullptr ? parameters_->find(name) : nullptr;
      if (value == nullptr || !value->is_scalar()) return unknown(node, name, value != nullptr);
      result += node.text.substr(from, begin - from) + value->text;
      bytes_ += value->text.size();
      if (bytes_ > most_bytes)
        throw DeckError({source_.diagnostic(node.place, "parameters make the deck too large")});
      from = end + 1;
      node.note += fmt::format("{}${{{}}} is {} ({})", node.note.empty() ? "" : "; ", name,
                               shortened(value->text, 60), origin(*value));
    }
    if (from == 0) return;
    node.text = result + node.text.substr(from);
    node.quoted = false;
  }

  std::string origin(const Node& value) const {
    return value.place.origin.empty() ? fmt::format("line {}", value.place.line) : value.place.origin;
  }

  void unknown(Node& node, const std::string& name, bool declared) {
    if (declared) {  // the block `parameters` itself is complained about when it is read
      node.kind = Node::Kind::broken;
      return;
    }
    const std::string known =
        names_.empty() ? "the deck declares no parameters" : "expected one of: " + join(names_);
    fail(node, fmt::format("unknown parameter \"{}\"", name), known, did_you_mean(name, names_));
  }

  void fail(Node& node, std::string message, std::string expectation, std::string suggestion) {
    Diagnostic diagnostic = source_.diagnostic(node.place, std::move(message));
    diagnostic.context = context_text({path_.begin(), path_.empty() ? path_.end() : path_.end() - 1});
    diagnostic.expectation = std::move(expectation);
    diagnostic.suggestion = std::move(suggestion);
    complaints_.add(std::move(diagnostic));
    node.kind = Node::Kind::broken;
  }

  static constexpr std::size_t most_bytes = 50'000'000;

  const Node* parameters_;
  const Source& source_;
  Complaints& complaints_;
  std::size_t bytes_ = 0;  ///< of all values put in
  std::vector<std::string> names_;
  std::vector<std::string> path_;
};

/// A parameter's value cannot refer to another parameter.
void reject_nested(const Node* parameters, const Source& source, Complaints& complaints) {
  if (parameters == nullptr) return;
  for (const auto& entry : parameters->entries) {
    if (entry.value.text.find("${") == std::string::npos) continue;
    Diagnostic diagnostic = source.diagnostic(
        entry.value.place, fmt::format("parameter \"{}\" refers to a parameter", entry.key));
    diagnostic.context = "in parameters";
    diagnostic.expectation = "expected a number or a text";
    complaints.add(std::move(diagnostic));
  }
}

}  // namespace

void substitute_parameters(Node& root, const Source& source, Complaints& complaints) {
  const Node* parameters = root.find("parameters");
  reject_nested(parameters, source, complaints);
  Substitution(parameters, source, complaints).walk(root);
}

}  // namespace tautline::deck
