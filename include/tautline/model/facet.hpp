#pragma once
/// @file
/// Nodes of a membrane or shell.

#include <algorithm>
#include <array>
#include <vector>

namespace tautline::model {

/// Node indices of a facet of three or four nodes, in order around it.
class FacetNodes {
 public:
  FacetNodes() = default;
  FacetNodes(int a, int b, int c) : node_{a, b, c, -1}, size_(3) {}
  FacetNodes(int a, int b, int c, int d) : node_{a, b, c, d}, size_(4) {}
  FacetNodes(const std::array<int, 3>& n) : FacetNodes(n[0], n[1], n[2]) {}
  FacetNodes(const std::array<int, 4>& n) : FacetNodes(n[0], n[1], n[2], n[3]) {}

  int size() const noexcept { return size_; }
  const int* begin() const noexcept { return node_.data(); }
  const int* end() const noexcept { return node_.data() + size_; }
  int operator[](int i) const noexcept { return node_[static_cast<std::size_t>(i)]; }
  bool operator==(const FacetNodes& other) const noexcept {
    return std::equal(begin(), end(), other.begin(), other.end());
  }

  /// The facet as triangles: itself, or the two of a quadrilateral.
  std::vector<std::array<int, 3>> triangles() const {
    const auto& n = node_;
    if (size_ == 3) return {{n[0], n[1], n[2]}};
    return {{n[0], n[1], n[2]}, {n[0], n[2], n[3]}};
  }

 private:
  std::array<int, 4> node_{-1, -1, -1, -1};
  int size_ = 0;
};

}  // namespace tautline::model
