#pragma once
/// @file
/// From the rows of an element to unknown blocks.

#include <array>
#include <span>
#include <vector>

#include <tautline/assembly/dof_map.hpp>
#include <tautline/assembly/kinematics.hpp>

namespace tautline::assembly {

/// Rows of three of an element: each an unknown block as it stands, or a sum over several.
class Expansion {
 public:
  template <class Nodes>
  Expansion(const Kinematics& kinematics, const DofMap& map, const Nodes& nodes, bool rotations) {
    bool plain = true;
    for (const int node : nodes) plain = plain && kinematics.plain(node);
    if (plain) {
      for (const int node : nodes) {
        rows_[static_cast<std::size_t>(n_rows_++)] = map.displacement_block[static_cast<std::size_t>(node)];
        if (rotations)
          rows_[static_cast<std::size_t>(n_rows_++)] = map.rotation_block[static_cast<std::size_t>(node)];
      }
      return;
    }
    for (const int node : nodes) {
      parts_.push_back(&kinematics.displacement(node));
      if (rotations) parts_.push_back(&kinematics.rotation(node));
    }
    n_rows_ = static_cast<int>(parts_.size());
    collect();
  }

  bool plain() const noexcept { return parts_.empty(); }
  /// Unknown blocks, each once.
  std::span<const int> blocks() const noexcept {
    return plain() ? std::span(rows_.data(), static_cast<std::size_t>(n_rows_))
                   : std::span<const int>(blocks_);
  }
  /// Place of a block among `blocks()`, or -1.
  int place_of(int block) const;
  /// Rows by unknowns; only where not plain.
  const MatX& matrix() const noexcept { return matrix_; }

  /// Values of the rows for an increment of all unknowns.
  template <class Vector>
  Vector rows_of(const std::vector<double>& unknowns) const {
    const VecX x = of_blocks(unknowns);
    if (plain()) return x;
    return matrix_ * x;
  }

  /// Adds forces on the rows to the unknowns.
  template <class Force>
  void add(const Force& values, std::vector<double>& to) const {
    if (plain())
      add_to_blocks(values, to);
    else
      add_to_blocks((matrix_.transpose() * values).eval(), to);
  }

  /// Adds K x increment of all unknowns, K given in the unknowns of `blocks()`.
  void add_product(const MatX& k, const std::vector<double>& increment, std::vector<double>& to) const {
    add_to_blocks((k * of_blocks(increment)).eval(), to);
  }

 private:
  VecX of_blocks(const std::vector<double>& unknowns) const {
    const auto list = blocks();
    VecX x(3 * static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i)
      x.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Vec3>(&unknowns[static_cast<std::size_t>(3 * list[i])]);
    return x;
  }
  template <class Values>
  void add_to_blocks(const Values& values, std::vector<double>& to) const {
    const auto list = blocks();
    for (std::size_t i = 0; i < list.size(); ++i)
      for (int c = 0; c < 3; ++c)
        to[static_cast<std::size_t>(3 * list[i] + c)] += values[3 * static_cast<Eigen::Index>(i) + c];
  }
  void collect();

  std::array<int, 8> rows_{};
  int n_rows_ = 0;
  std::vector<const std::vector<Dependence>*> parts_;
  std::vector<int> blocks_;
  MatX matrix_;
};

}  // namespace tautline::assembly
