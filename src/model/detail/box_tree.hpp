#pragma once
/// @file
/// Boxes in space and which of them meet: a tree halved at the median, O(n log n) for boxes of like size.

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <tautline/core/types.hpp>

namespace tautline::model::detail {

struct Box {
  Vec3 low, high;

  static Box around(const Vec3& a, const Vec3& b, double margin) {
    return {a.cwiseMin(b).array() - margin, a.cwiseMax(b).array() + margin};
  }
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  Box joined(const Box& other) const { return {low.cwiseMin(other.low), high.cwiseMax(other.high)}; }
};

class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (!boxes.empty()) build(0, static_cast<int>(boxes.size()));
  }

  /// Calls visit(i, j) once for every two boxes that meet, i < j, until `most` pairs were compared.
  template <class Visit>
  void for_each_pair(long most, const Visit& visit) const {
    left_ = most;
    if (!branches_.empty()) within(0, visit);
  }

 private:
  static constexpr int leaf_size = 8;
  struct Branch {
    Box box;
    int first, last;            // of order_
    int left = -1, right = -1;  // branches
  };

  int build(int first, int last) {
    const int index = static_cast<int>(branches_.size());
    Box box = boxes_[order_[first]];
    for (int i = first + 1; i < last; ++i) box = box.joined(boxes_[order_[i]]);
    branches_.push_back({box, first, last});
    if (last - first <= leaf_size) return index;
    int axis = 0;
    (box.high - box.low).maxCoeff(&axis);
    const int middle = (first + last) / 2;
    const auto centre = [&](int i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](int a, int b) { return std::pair(centre(a), a) < std::pair(centre(b), b); });
    const int left = build(first, middle), right = build(middle, last);
    branches_[index].left = left;
    branches_[index].right = right;
    return index;
  }

  template <class Visit>
  void compare(int i, int j, const Visit& visit) const {
    --left_;
    if (boxes_[i].meets(boxes_[j])) visit(std::min(i, j), std::max(i, j));
  }

  template <class Visit>
  void within(int at, const Visit& visit) const {
    const Branch& branch = branches_[at];
    if (branch.left >= 0) {
      within(branch.left, visit);
      within(branch.right, visit);
      return between(branch.left, branch.right, visit);
    }
    for (int i = branch.first; i < branch.last; ++i)
      for (int j = i + 1; j < branch.last; ++j) compare(order_[i], order_[j], visit);
  }

  template <class Visit>
  void between(int at, int other, const Visit& visit) const {
    const Branch &a = branches_[at], &b = branches_[other];
    if (left_ <= 0 || !a.box.meets(b.box)) return;
    const bool split_a = a.left >= 0 && (b.left < 0 || a.last - a.first >= b.last - b.first);
    if (split_a) {
      between(a.left, other, visit);
      between(a.right, other, visit);
    } else if (b.left >= 0) {
      between(at, b.left, visit);
      between(at, b.right, visit);
    } else {
      for (int i = a.first; i < a.last; ++i)
        for (int j = b.first; j < b.last; ++j) compare(order_[i], order_[j], visit);
    }
  }

  const std::vector<Box>& boxes_;
  std::vector<int> order_;
  std::vector<Branch> branches_;
  mutable long left_ = 0;
};

}  // namespace tautline::model::detail
