#pragma once
/// @file
/// Anderson's acceleration of a fixed point x = g(x). Source: Anderson (1965), J. ACM 12; Walker & Ni (2011),
/// SIAM J. Numer. Anal. 49.

#include <Eigen/QR>
#include <deque>
#include <tautline/core/types.hpp>

namespace tautline {

class Anderson {
 public:
  explicit Anderson(std::size_t depth) : depth_(depth) {}

  /// The next iterate from x and g(x): g less the combination of the last steps that cancels g(x) - x best.
  VecX next(const VecX& x, const VecX& gx) {
    const VecX f = gx - x;
    if (f_.size() > 0) {
      df_.push_back(f - f_);
      dg_.push_back(gx - g_);
      if (df_.size() > depth_) {
        df_.pop_front();
        dg_.pop_front();
      }
    }
    f_ = f;
    g_ = gx;
    if (df_.empty()) return gx;
    MatX F(f.size(), df_.size());
    for (std::size_t k = 0; k < df_.size(); ++k) F.col(static_cast<Eigen::Index>(k)) = df_[k];
    const VecX weight = F.colPivHouseholderQr().solve(f);
    VecX mixed = gx;
    for (std::size_t k = 0; k < dg_.size(); ++k) mixed -= weight[static_cast<Eigen::Index>(k)] * dg_[k];
    return mixed;
  }

  void restart() {
    df_.clear();
    dg_.clear();
    f_.resize(0);
  }

 private:
  std::size_t depth_;
  VecX f_, g_;
  std::deque<VecX> df_, dg_;
};

}  // namespace tautline
