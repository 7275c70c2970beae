#pragma once
/// @file
/// An error about nodes of a net, whose names the caller knows.

#include <string>
#include <tautline/core/error.hpp>
#include <utility>
#include <vector>

namespace tautline::formfinding {

/// A sentence with nodes in it: by number, from 1, in what(); by name for who has names.
class NodeError : public ModelError {
 public:
  /// @param[in] before, after  the sentence around the nodes
  NodeError(const std::string& before, std::vector<int> nodes, const std::string& after)
      : ModelError(before + numbers(nodes) + after),
        before_(before),
        after_(after),
        nodes_(std::move(nodes)) {}

  /// The sentence with `name(node)` for each node.
  template <class Name>
  std::string with(const Name& name) const {
    std::string names;
    for (const int node : nodes_) names += (names.empty() ? "" : ", ") + name(node);
    return before_ + names + after_;
  }

 private:
  static std::string numbers(const std::vector<int>& nodes) {
    std::string text;
    for (const int node : nodes) text += (text.empty() ? "node " : ", ") + std::to_string(node + 1);
    return text;
  }

  std::string before_, after_;
  std::vector<int> nodes_;
};

/// Force densities that cancel out around a node, so that equilibrium leaves its place open.
class CancelledDensities : public NodeError {
  using NodeError::NodeError;
};

}  // namespace tautline::formfinding
