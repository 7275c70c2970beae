#pragma once
/// @file
/// Every stage is a path: from boundary state A (lambda = 0) to B (lambda = 1). Full step first, halved on
/// failure, doubled on success. Theory: docs/theory/stages.md

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tautline/analysis/newton.hpp>

namespace tautline::analysis {

/// A problem whose boundary state depends on lambda; at lambda = 0 its present point is in equilibrium.
///
/// Some unknowns may be prescribed as functions of lambda. They are where lambda has them in every residual
/// and at every point accepted, so that no solver can lose them.
class PathProblem : public NonlinearProblem {
 public:
  virtual void set_lambda(double lambda) = 0;
  /// Moves the present point towards the equilibrium at the lambda just set, as far as a tangent can tell;
  /// false if the tangent is singular. A problem with prescribed unknowns needs it for a good first guess.
  virtual bool predict(Workspace&) { return true; }
  virtual void commit() = 0;     ///< keeps the present point
  virtual void roll_back() = 0;  ///< returns to the point kept last
  /// The present point and its lambda, to be returned to at any time.
  struct Kept {
    virtual ~Kept() = default;
  };
  virtual std::shared_ptr<const Kept> keep() const = 0;
  virtual void return_to(const Kept& kept) = 0;
  /// q = -d residual / d lambda in the present state: what one unit of lambda adds to the load.
  virtual void load_rate(la::Vector& q) = 0;
  /// Weights d that make x^T d x the square of a motion's size without unit: displacements over the
  /// structure's size, rotations in rad times the square root of `rotation_weight`; zero where held.
  virtual void weights(double rotation_weight, la::Vector& d) const = 0;
  /// What the prescribed unknowns go while lambda grows by one; zero elsewhere.
  virtual void drive_rate(la::Vector& w) const { w.set_zero(); }
  /// w^T d w of that motion, with the weights that its unknowns would have if they were free.
  virtual double drive_size(double /*rotation_weight*/) const { return 0; }
  /// Whether anything depends on lambda where no free unknown is loaded by it: reactions, prescribed motions.
  virtual bool changes_at_rest() { return false; }
};

/// How a path that is followed by its length goes on from a point: with the point, all that taking it up
/// again needs.
struct ArcPlace {
  double length = 0, first_length = 0;  ///< of the next step and of the first, in the metric of the path
  double lambda_weight = 0;             ///< of the square of lambda in that metric
  double rotation_weight = 1;           ///< of the square of a rotation in that metric
  int direction = 1;                    ///< +1: with the tangent along which lambda grows; -1: against it
  int points = 0, critical = 0, bifurcations = 0;  ///< met so far
};

struct PathPoint {
  double lambda = 0;
  NewtonSummary newton;
  int negative_directions = 0;  ///< in which the structure is unstable there
  std::optional<ArcPlace> arc;  ///< of a path followed by its length
};

/// A point at which a path becomes unstable or stable again.
struct CriticalPoint {
  enum class Kind { limit, bifurcation } kind = Kind::bifurcation;
  double lambda = 0;
  int negative_before = 0, negative_after = 0;  ///< negative pivots on either side
  double eigenvalue = 0;  ///< of K about the weights at the point found, over that at the start of the search
  double load_share = 0;  ///< cosine between critical mode and load: zero at a bifurcation [-]
  la::Vector mode;        ///< critical mode, x^T d x = 1
  std::shared_ptr<const PathProblem::Kept> kept;  ///< the problem at the point
};

/// What is tried at the end of a path that gave up: a stable equilibrium under what acts at lambda = 1.
enum class LastResort { none, descent, dynamic_relaxation };

/// How that went.
struct LastResortSummary {
  LastResort method = LastResort::none;
  std::string gave_up;        ///< why the path ended
  double gave_up_at = 0;      ///< lambda there
  int steps = 0;              ///< of the method
  int peaks = 0;              ///< of kinetic energy, in dynamic relaxation
  double residual = 0;        ///< where the method ended, of the reference force [-]
  int newton_iterations = 0;  ///< from there
};

/// Where a path begins, and what is done where it cannot be followed.
struct PathStart {
  double lambda = 0;  ///< not 0 where a run is taken up again
  /// No equilibrium is known yet, and so there is no path to keep to: where Newton's method fails from here
  /// the search goes downhill in energy (see descend).
  bool unknown = false;
  std::optional<ArcPlace> arc;                ///< of a path followed by its length, taken up again
  LastResort last_resort = LastResort::none;  ///< of a path followed by load
};

struct PathSummary {
  bool reached = false;
  std::string reason;             ///< one sentence: reached, or why not and what to try
  std::vector<PathPoint> points;  ///< converged ones, in order
  bool singular = false;          ///< the last failed attempt met a singular tangent
  int failed_attempts = 0;
  int newton_iterations = 0;                     ///< of all attempts
  int descent_steps = 0;                         ///< downhill in energy, where no equilibrium was known
  std::optional<LastResortSummary> last_resort;  ///< what was tried after the path gave up
  la::Inertia inertia;                           ///< of the tangent at the end
  std::vector<CriticalPoint> critical;           ///< in the order in which the path meets them
  double lambda() const { return points.empty() ? 0 : points.back().lambda; }
};

/// What is told on the way.
struct PathCallback {
  std::function<void(double, int, double)> iteration;  ///< (lambda aimed at, iteration, relative residual)
  std::function<void(const PathPoint&)> converged;     ///< the problem stands at the point
  std::function<void(const CriticalPoint&)> critical;  ///< the problem stands anywhere and must stay there
  std::function<void(const LastResortSummary&)> gave_up = {};  ///< before the last resort is tried
};

/// @brief Follows the path to lambda = 1 or as far as it goes; the problem is left at the last converged
/// point. Collective.
/// @throws Interrupted between iterations if the user asked for it; the problem is then at its last converged
/// point
PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback = {}, const PathStart& start = {});

}  // namespace tautline::analysis
