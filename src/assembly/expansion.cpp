#include "assembly/expansion.hpp"

#include <algorithm>

namespace tautline::assembly {

int Expansion::place_of(int block) const {
  const auto list = blocks();
  const auto found = std::find(list.begin(), list.end(), block);
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

void Expansion::collect() {
  for (const auto* part : parts_)
    for (const auto& dependence : *part) blocks_.push_back(dependence.block);
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
  matrix_ = MatX::Zero(3 * n_rows_, 3 * static_cast<Eigen::Index>(blocks_.size()));
  for (int row = 0; row < n_rows_; ++row)
    for (const auto& dependence : *parts_[static_cast<std::size_t>(row)])
      matrix_.block<3, 3>(3 * row, 3 * place_of(dependence.block)) += dependence.matrix;
}

}  // namespace tautline::assembly
