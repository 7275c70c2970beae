#pragma once
/// @file
/// Errors about nodes and branches of a net, whose names the caller knows.

#include <string>
#include <tautline/core/error.hpp>
#include <utility>
#include <vector>

namespace tautline::formfinding {

/// A part of a sentence: words, or a node or branch of the net.
struct NetWord {
  enum class Kind { words, node, branch };
  Kind kind = Kind::words;
  std::string words;
  int index = 0;

  NetWord(std::string text) : words(std::move(text)) {}  // NOLINT: words are words
  NetWord(const char* text) : words(text) {}             // NOLINT
  NetWord(Kind what, int number) : kind(what), index(number) {}
};

inline NetWord node_word(int node) {
  return {NetWord::Kind::node, node};
}
inline NetWord branch_word(int branch) {
  return {NetWord::Kind::branch, branch};
}

/// A sentence with nodes and branches in it: by number, from 1, in what(); by name for who has names.
class NetError : public ModelError {
 public:
  explicit NetError(std::vector<NetWord> sentence)
      : ModelError(text(
            sentence, [](int node) { return "node " + std::to_string(node + 1); },
            [](int branch) { return "branch " + std::to_string(branch + 1); })),
        sentence_(std::move(sentence)) {}

  /// The sentence with `node(i)` and `branch(b)` for each of them.
  template <class NodeName, class BranchName>
  std::string with(const NodeName& node, const BranchName& branch) const {
    return text(sentence_, node, branch);
  }

 private:
  template <class NodeName, class BranchName>
  static std::string text(const std::vector<NetWord>& sentence, const NodeName& node,
                          const BranchName& branch) {
    std::string text;
    for (const NetWord& word : sentence)
      text += word.kind == NetWord::Kind::words  ? word.words
              : word.kind == NetWord::Kind::node ? node(word.index)
                                                 : branch(word.index);
    return text;
  }

  std::vector<NetWord> sentence_;
};

/// A sentence about nodes alone.
class NodeError : public NetError {
 public:
  /// @param[in] before, after  the sentence around the nodes
  NodeError(const std::string& before, const std::vector<int>& nodes, const std::string& after)
      : NetError(list(before, nodes, after)) {}

 private:
  static std::vector<NetWord> list(const std::string& before, const std::vector<int>& nodes,
                                   const std::string& after) {
    std::vector<NetWord> sentence{before};
    for (const int node : nodes) {
      if (sentence.size() > 1) sentence.emplace_back(", ");
      sentence.push_back(node_word(node));
    }
    sentence.emplace_back(after);
    return sentence;
  }
};

/// Force densities that cancel out around a node, so that equilibrium leaves its place open.
class CancelledDensities : public NodeError {
  using NodeError::NodeError;
};

}  // namespace tautline::formfinding
