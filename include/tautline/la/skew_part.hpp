#pragma once
/// @file
/// The skew part of a matrix whose symmetric part is factored: few blocks, most matrices have none. Theory:
/// docs/theory/newton.md#loads-without-a-potential

#include <map>
#include <utility>

#include <tautline/core/types.hpp>
#include <tautline/la/direct_solver.hpp>
#include <tautline/la/vector.hpp>

namespace tautline::la {

/// Blocks of three of a skew matrix, of this rank's rows.
class SkewPart {
 public:
  explicit SkewPart(const BlockLayout& layout) : layout_(layout) {}

  /// Adds a block; those of other ranks' rows are passed over.
  void add(int row, int column, const Mat3& block);
  /// Drops what has cancelled. Collective, after the last add.
  void finish();
  bool empty() const noexcept { return empty_; }
  /// y = S x. Collective.
  void multiply(const Vector& x, Vector& y) const;

 private:
  struct Sum {
    Mat3 value = Mat3::Zero();
    double magnitude = 0;  ///< sum of what was added
  };
  BlockLayout layout_;
  std::map<std::pair<int, int>, Sum> blocks_;
  bool empty_ = true;
};

/// @brief Makes of x, which solves A x = b with the factors given, the solution of (A + S) x = b.
///
/// By GMRES about the factors: no more products than twice the number of nodes with a skew block of their
/// own, as a rule a few. Collective.
void correct_for_skew_part(DirectSolver& factored, const SkewPart& skew, const Vector& b, Vector& x);

/// Solves (A + S) x = b.
void solve(DirectSolver& factored, const SkewPart& skew, const Vector& b, Vector& x);

}  // namespace tautline::la
