#pragma once
/// @file
/// What a growing load does to a state at rest, linear but for cables that go slack and taut on the way, and
/// where that loses its stability. Theory: docs/theory/buckling.md

#include <optional>
#include <vector>

#include <tautline/analysis/path.hpp>
#include <tautline/assembly/system.hpp>
#include <tautline/la/eigen_solver.hpp>

namespace tautline::steps {

class BucklingCourse {
 public:
  /// @pre the stage of the loads was begun, and the tangent at rest is positive definite
  BucklingCourse(assembly::System& system, analysis::Workspace& workspace);
  ~BucklingCourse();
  BucklingCourse(const BucklingCourse&) = delete;
  BucklingCourse& operator=(const BucklingCourse&) = delete;

  /// Whether the loads stress anything.
  bool stresses() const { return stresses_; }
  /// Goes to the piece of the way that has the first factor, and finds up to `count` there. Collective.
  /// @param which lowest: of positive sign; both: also negative ones, of the piece that begins at rest
  void find(int count, la::Extreme which);

  const std::vector<double>& factors() const { return factors_; }
  la::EigenPairs& pairs() { return pairs_; }
  /// Where the next cable would go slack or taut, if any does.
  std::optional<double> next_switch() const;
  bool stopped_short() const { return stopped_short_; }
  /// Branch of each cable at the first factor.
  const std::vector<assembly::Branch>& branches() const { return branches_; }
  /// Response to all loads up to a factor beyond the last switch.
  la::Vector response_at(double factor) const;

 private:
  assembly::Ray ray() const { return {lambda_, &way_, &rate_, h_}; }
  bool settle();
  bool respond(const assembly::Ray& ahead);
  bool turn_corners();
  double rounding_of(int cable) const;
  void advance(double step);
  bool is_stable(const la::SymmetricMatrix& tangent) const;
  void take_factors_here(const la::SymmetricMatrix& before, const la::SymmetricMatrix& now, int count);

  assembly::System& system_;
  analysis::Workspace& workspace_;
  double lambda_ = 0, h_ = 0;
  la::Vector way_, rate_;
  std::vector<assembly::Branch> branches_;
  std::vector<assembly::Pull> pulls_;
  std::vector<double> tension_;  // of `pulls_` at lambda
  std::vector<double> factors_;
  la::EigenPairs pairs_;
  bool stresses_ = false, stopped_short_ = false;
};

}  // namespace tautline::steps
