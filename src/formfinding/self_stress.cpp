#include <tautline/formfinding/self_stress.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <formfinding/equilibrium_matrix.hpp>
#include <formfinding/nearest_cone.hpp>

namespace tautline::formfinding {

namespace {

/// Chooses one state out of all: t = states c.
class StateChoice {
 public:
  StateChoice(const MatX& states, const SelfStressWish& wish, double nothing)
      : states_(states), wish_(wish), carries_(static_cast<std::size_t>(states.rows())) {
    for (Eigen::Index b = 0; b < states.rows(); ++b) {
      carries_[static_cast<std::size_t>(b)] = states.row(b).norm() > nothing;
      if (carries_[static_cast<std::size_t>(b)] && wish.pulls_only[static_cast<std::size_t>(b)])
        cables_.push_back(b);
    }
    ask();
  }

  void choose(SelfStressResult& result) {
    result.scaled = scaled_;
    const Eigen::CompleteOrthogonalDecomposition<MatX> asked(asked_);
    const VecX particular = asked.solve(wanted_ / size_);
    const MatX free = null_space(asked);
    const MatX uneven = unevenness();
    VecX c = particular;
    if (free.cols() > 0) {
      const MatX of_free = uneven * free;
      const VecX without = -(uneven * particular);
      c += free * of_free.householderQr().solve(without);
      if (!pulls(c))
        if (const auto y = nearest(of_free, without, particular, free)) c = particular + free * *y;
    }
    if (states_.cols() == 1 && count_pushed(-c) < count_pushed(c) && !scaled_) c = -c;
    result.tension = size_ * (states_ * c);
    for (std::size_t b = 0; b < carries_.size(); ++b)
      if (!carries_[b]) result.tension[static_cast<Eigen::Index>(b)] = 0;
    result.found = pulls(c) && c.norm() > 0;
    for (const Eigen::Index b : cables_)
      if (states_.row(b).dot(c) <= 0) result.wrong.push_back(static_cast<int>(b));
    std::sort(result.wrong.begin(), result.wrong.end(),
              [&](int a, int b) { return result.tension[a] < result.tension[b]; });
    for (std::size_t b = 0; b < carries_.size(); ++b)
      if (!carries_[b]) result.unstressed.push_back(static_cast<int>(b));
  }

 private:
  /// Means asked for: of the groups that state a tension, or 1 N over all cables, or of the first state.
  void ask() {
    const auto mean_of = [&](const auto& members) {
      VecX row = VecX::Zero(states_.cols());
      for (const auto b : members) row += states_.row(b).transpose() / static_cast<double>(members.size());
      return row;
    };
    const auto n = static_cast<Eigen::Index>(wish_.group.size());
    asked_.resize(n, states_.cols());
    wanted_.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      asked_.row(i) = mean_of(wish_.group[static_cast<std::size_t>(i)]).transpose();
      wanted_[i] = wish_.tension[static_cast<std::size_t>(i)];
    }
    scaled_ = n > 0 && asked_.norm() > 1e-9;
    if (scaled_) {
      size_ = wanted_.cwiseAbs().maxCoeff();
      return;
    }
    asked_.resize(1, states_.cols());
    wanted_ = VecX::Ones(1);
    asked_.row(0) = mean_of(cables_).transpose();
    if (asked_.norm() < 1e-9) asked_.row(0) = VecX::Unit(states_.cols(), 0).transpose();
  }

  static MatX null_space(const Eigen::CompleteOrthogonalDecomposition<MatX>& of) {
    const Eigen::Index n = of.cols(), rank = of.rank();
    const MatX z = of.matrixZ();  // rows of P A Z^T vanish behind the rank
    return (of.colsPermutation() * z.transpose().rightCols(n - rank)).eval();
  }

  /// Deviation of each cable from the mean of all; forces of bars count little, and only where cables leave
  /// them open.
  MatX unevenness() const {
    constexpr double little = 1e-3;
    MatX rows = little * states_;
    VecX mean = VecX::Zero(states_.cols());
    for (const Eigen::Index b : cables_)
      mean += states_.row(b).transpose() / static_cast<double>(cables_.size());
    for (const Eigen::Index b : cables_) rows.row(b) = states_.row(b) - (1 - little) * mean.transpose();
    return rows;
  }

  bool pulls(const VecX& c) const { return count_pushed(c) == 0; }
  std::ptrdiff_t count_pushed(const VecX& c) const {
    return std::count_if(cables_.begin(), cables_.end(),
                         [&](Eigen::Index b) { return states_.row(b).dot(c) <= 0; });
  }

  /// The most even of those in which every cable pulls, with a margin if there is one.
  std::optional<VecX> nearest(const MatX& of_free, const VecX& without, const VecX& particular,
                              const MatX& free) const {
    const auto n = static_cast<Eigen::Index>(cables_.size());
    MatX rows(n, free.cols());
    VecX least(n);
    const double mean = (states_ * particular).cwiseAbs().mean();
    for (const double margin : {1e-2, 1e-4}) {
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto state = states_.row(cables_[static_cast<std::size_t>(i)]);
        rows.row(i) = state * free;
        least[i] = margin * mean - state.dot(particular);
      }
      if (auto y = constrained_least_squares(of_free, without, rows, least)) return y;
    }
    return std::nullopt;
  }

  const MatX& states_;
  const SelfStressWish& wish_;
  std::vector<bool> carries_;
  std::vector<Eigen::Index> cables_;  // that carry something in some state
  MatX asked_;
  VecX wanted_;
  double size_ = 1;
  bool scaled_ = false;
};

/// Mechanisms that are no rigid motion: what is orthogonal to those in the whole space of both.
MatX internal_mechanisms(const MatX& all, const MatX& rigid) {
  if (rigid.cols() == 0 || all.cols() == 0) return all;
  const MatX parts = all.transpose() * rigid;
  const Eigen::ColPivHouseholderQR<MatX> qr(parts);
  const MatX q = qr.householderQ() * MatX::Identity(all.cols(), all.cols());
  return all * q.rightCols(all.cols() - std::min(all.cols(), rigid.cols()));
}

/// Calladine and Pellegrino's test: work of the product forces on every mechanism.
void judge_stability(const Net& net, const EquilibriumMatrix& equilibrium, const MatX& mechanisms,
                     SelfStressResult& result) {
  constexpr Eigen::Index most_eigenvalues = 1000;
  constexpr double nothing = 1e-9;  // of the largest force density
  if (mechanisms.cols() == 0) {
    result.stable = true;
    return;
  }
  VecX q = result.tension;
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto& [i, j] = net.branches[b];
    q[static_cast<Eigen::Index>(b)] /=
        (net.nodes[static_cast<std::size_t>(j)] - net.nodes[static_cast<std::size_t>(i)]).norm();
  }
  const double limit = nothing * q.cwiseAbs().maxCoeff();
  const MatX work = mechanisms.transpose() * (equilibrium.geometric(q) * mechanisms);
  if (mechanisms.cols() > most_eigenvalues) {
    const MatX less = work - limit * MatX::Identity(work.rows(), work.cols());
    result.stable = Eigen::LLT<MatX>(less).info() == Eigen::Success;
    result.least_stiffness = std::nan("");
    return;
  }
  const Eigen::SelfAdjointEigenSolver<MatX> eigen((work + work.transpose()) / 2);
  result.least_stiffness = eigen.eigenvalues()[0];
  result.stable = result.least_stiffness > limit;
  result.softest = equilibrium.displacements(mechanisms * eigen.eigenvectors().col(0));
}

}  // namespace

SelfStressResult find_self_stress(const Net& net, const SelfStressWish& wish,
                                  const SelfStressOptions& options) {
  const EquilibriumMatrix equilibrium(net);
  const NullSpaces spaces = null_spaces(equilibrium.matrix(), options.tolerance, options.dense_limit);
  const MatX rigid = equilibrium.rigid_motions();
  const MatX mechanisms = internal_mechanisms(spaces.left, rigid);
  SelfStressResult result;
  result.states = static_cast<int>(spaces.right.cols());
  result.rigid = static_cast<int>(rigid.cols());
  result.mechanisms = static_cast<int>(mechanisms.cols());
  result.equations = equilibrium.equations();
  result.smallest = spaces.smallest;
  result.dropped = spaces.dropped;
  result.tension = VecX::Zero(static_cast<Eigen::Index>(net.branches.size()));
  if (result.states == 0) return result;
  StateChoice(spaces.right, wish, std::max(1e-9, 10 * options.tolerance)).choose(result);
  const VecX left = equilibrium.matrix() * result.tension;
  for (const Vec3& force : equilibrium.displacements(left))
    result.out_of_balance = std::max(result.out_of_balance, force.norm());
  judge_stability(net, equilibrium, mechanisms, result);
  return result;
}

}  // namespace tautline::formfinding
