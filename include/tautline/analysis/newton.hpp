#pragma once
/// @file
/// Newton's method for the equilibrium of anything that has a residual and a tangent. Theory:
/// docs/theory/newton.md

#include <functional>
#include <string>
#include <vector>

#include <tautline/analysis/newton_options.hpp>
#include <tautline/la/direct_solver.hpp>
#include <tautline/la/skew_part.hpp>
#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/la/vector.hpp>

namespace tautline::analysis {

/// Norms of like with like: forces beside forces, moments beside moments.
struct ResidualNorms {
  double force = 0, moment = 0;  ///< out-of-balance [N], [N m]
  double reference_force = 0,
         reference_moment = 0;  ///< what they are compared with: the sum of |element forces| node by node
  double rounding_force = 0,
         rounding_moment =
             0;  ///< what the rounding of the stiffest element may leave [N], [N m]; 0: not known
};

/// What Newton solves: gradient(x) = 0. The unknowns are increments from the point where the solve began;
/// finite rotations are composed by the problem (see accept).
class NonlinearProblem {
 public:
  virtual ~NonlinearProblem() = default;
  virtual const la::BlockLayout& layout() const = 0;
  /// Residual (internal minus external force) at x. Collective.
  virtual void residual(const la::Vector& x, la::Vector& f) = 0;
  /// Tangent at the last accepted point.
  virtual void tangent(la::SymmetricMatrix& k) = 0;
  /// Tangent there with stresses foretold by the last increment: what Newton's method uses away from balance.
  /// @return whether any are
  virtual bool extrapolated_tangent(la::SymmetricMatrix& k) {
    tangent(k);
    return false;
  }
  /// What the derivative of the residual there has beside `tangent`, its symmetric part.
  virtual la::SkewPart skew_part() { return la::SkewPart(layout()); }
  /// x becomes the point about which increments are composed.
  virtual void accept(const la::Vector& x) = 0;
  /// The accepted point becomes the origin of the next solve's unknowns.
  virtual void restart() = 0;
  virtual ResidualNorms norms(const la::Vector& f) const = 0;
  /// Largest displacement in an increment, relative to the structure's size [-].
  virtual double relative_size(const la::Vector& increment) const = 0;
  /// What elements that only pull would add to each row's sum of stiffnesses if all were taut [N/m]: a scale
  /// for unknowns that nothing resists yet. False if there are no such elements.
  virtual bool taut_stiffness(la::Vector& sums) const {
    sums.set_zero();
    return false;
  }
  /// Limits the axial stiffness of elements that only pull [N]; infinity gives them their own back.
  /// @return the largest ratio of an element's own stiffness to its limited one, 1 where the limit is none
  virtual double soften(double /*limit*/) { return 1; }
};

struct NewtonIteration {
  ResidualNorms norms;
  double increment = 0;  ///< relative to the structure's size [-]
  double step = 1;       ///< line-search factor
};

enum class NewtonStatus { converged, too_many_iterations, diverged, singular };

/// How a solve went, with a sentence that holds both sides of the inequality that ended it.
struct NewtonSummary {
  NewtonStatus status = NewtonStatus::diverged;
  std::string reason;
  std::vector<NewtonIteration> iterations;  ///< the first is the start
  int newton_iterations() const { return iterations.empty() ? 0 : static_cast<int>(iterations.size()) - 1; }
  bool converged() const { return status == NewtonStatus::converged; }
};

/// Matrix and factors that live through a whole run, so that the pattern is analysed once.
struct Workspace {
  la::SymmetricMatrix tangent;
  la::DirectSolver solver;
};

/// Called after each iteration with (iteration, relative residual).
using IterationCallback = std::function<void(int, double)>;

/// Whether iterates far from balance may have more unstable directions than the point where the solve began.
/// `kept`: the solve gives up there, since it would come to some other equilibrium.
enum class Stability { any, kept };

/// @brief Solves from the problem's present point. Never throws for non-convergence. Collective.
NewtonSummary solve_newton(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                           const IterationCallback& callback = {}, Stability stability = Stability::any);

}  // namespace tautline::analysis
