#include "steps/buckling_course.hpp"

#include <algorithm>
#include <cmath>

namespace tautline::steps {

using assembly::Branch;

namespace {

constexpr double small_deformation = 1e-5;  // of the elements, where the tangent is linear in the load
constexpr int most_rounds = 20;             // until branches and response agree
constexpr int most_places = 30;             // along the load where cables go slack or taut
constexpr double one_place = 1e-4;  // of the load factor: a place is left whole, whatever rounding does there

la::Vector copy_of(const la::Vector& x) {
  la::Vector copy = la::Vector::like(x);
  copy.copy(x);
  return copy;
}

}  // namespace

BucklingCourse::BucklingCourse(assembly::System& system, analysis::Workspace& workspace)
    : system_(system),
      workspace_(workspace),
      way_(system.layout()),
      rate_(system.layout()),
      branches_(system.model().cables.size(), Branch::own) {
  way_.set_zero();
  rate_.set_zero();
  pulls_ = system.pulls(rate_, 1);
  for (const auto& pull : pulls_) {
    tension_.push_back(pull.rest);
    branches_[static_cast<std::size_t>(pull.cable)] =
        pull.rest >= -rounding_of(pull.cable) ? Branch::taut : Branch::slack;
  }
  stresses_ = settle();
}

BucklingCourse::~BucklingCourse() {
  system_.hold_branches({});
}

/// What is left of a tension where a cable is just as long as unstressed [N].
double BucklingCourse::rounding_of(int cable) const {
  constexpr double of_stiffness = 1e-14, of_tension = 1e-10;
  double most = 0;
  for (const double tension : tension_) most = std::max(most, std::abs(tension));
  const auto& model = system_.model();
  return of_stiffness * model.axial_stiffness(model.cables[static_cast<std::size_t>(cable)]) +
         of_tension * most;
}

bool BucklingCourse::is_stable(const la::SymmetricMatrix& tangent) const {
  la::DirectSolver solver;
  if (!solver.factor(tangent)) return false;
  const auto inertia = solver.inertia();
  return inertia.negative == 0 && inertia.null == 0;
}

/// Rate of the linear response, with the stiffness at rest, or with the stresses there if that is not stable.
/// @return whether anything is stressed
bool BucklingCourse::respond(const assembly::Ray& ahead) {
  constexpr double rounding = 1e-12;  // of a motion that deforms nothing
  workspace_.tangent = system_.tangent_towards(ahead);
  if (lambda_ > 0 && !is_stable(workspace_.tangent)) workspace_.tangent = system_.tangent_at(ahead);
  workspace_.solver.factor(workspace_.tangent);
  la::Vector load(system_.layout());
  system_.load_rate(load);
  workspace_.solver.solve(load, rate_);
  system_.add_drives(rate_);
  const double most = system_.largest_deformation(rate_);
  double farthest = 0;
  for (const Vec3& way : system_.nodal(rate_).displacement) farthest = std::max(farthest, way.norm());
  if (most <= rounding * farthest / system_.size()) return false;
  h_ = small_deformation / most;
  return true;
}

/// Cables without tension go where the response takes them. @return whether one of them changes its branch
bool BucklingCourse::turn_corners() {
  constexpr double nothing = 1e-9;
  double fastest = 0;
  for (const auto& pull : pulls_) fastest = std::max(fastest, std::abs(pull.rate));
  bool changed = false;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    const auto& pull = pulls_[i];
    if (std::abs(tension_[i]) > rounding_of(pull.cable) || std::abs(pull.rate) <= nothing * fastest) continue;
    auto& branch = branches_[static_cast<std::size_t>(pull.cable)];
    const Branch wanted = pull.rate > 0 ? Branch::taut : Branch::slack;
    changed = changed || branch != wanted;
    branch = wanted;
  }
  return changed;
}

/// Finds branches at the present place and a response that agree. @return whether anything is stressed
bool BucklingCourse::settle() {
  constexpr double same = 1e-9;
  const bool may_wrinkle = system_.may_wrinkle();
  for (int round = 0; round < most_rounds; ++round) {
    system_.hold_branches(branches_);
    la::Vector last = copy_of(rate_);
    if (!respond({lambda_, &way_, &last, h_})) return false;
    pulls_ = system_.pulls(rate_, h_);
    const bool turned = turn_corners();
    last.add(-1, rate_);
    if (!turned && (!may_wrinkle || last.norm() <= same * rate_.norm())) return true;
  }
  return true;
}

std::optional<double> BucklingCourse::next_switch() const {
  std::optional<double> next;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    const auto& pull = pulls_[i];
    if (std::abs(tension_[i]) <= rounding_of(pull.cable) || tension_[i] * pull.rate >= 0) continue;
    const double step = -tension_[i] / pull.rate;
    if (!next || step < *next - lambda_) next = lambda_ + step;
  }
  return next;
}

/// Along the present response to the next switch.
void BucklingCourse::advance(double step) {
  constexpr double together = 1e-6;  // of their tensions: cables of a symmetric structure go slack as one
  way_.add(step, rate_);
  lambda_ += step;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    const auto& pull = pulls_[i];
    const double before = tension_[i];
    tension_[i] += step * pull.rate;
    if (before == 0 || std::abs(tension_[i]) > rounding_of(pull.cable) + together * std::abs(before))
      continue;
    tension_[i] = 0;
    branches_[static_cast<std::size_t>(pull.cable)] = pull.rate > 0 ? Branch::taut : Branch::slack;
  }
  system_.hold_branches(branches_);
}

/// Factors where a cable that goes slack takes the stability away: the modes that it made stable.
void BucklingCourse::take_factors_here(const la::SymmetricMatrix& before, const la::SymmetricMatrix& now,
                                       int count) {
  constexpr double rounding = 1e-9;
  const auto lost = now.plus(-1, before);
  auto found = la::solve_extreme(lost, before, count, la::Extreme::lowest);
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    if (found.values[i] > -1 + rounding) continue;
    factors_.push_back(lambda_);
    pairs_.values.push_back(found.values[i]);
    pairs_.residuals.push_back(found.residuals[i]);
    pairs_.vectors.push_back(std::move(found.vectors[i]));
  }
}

void BucklingCourse::find(int count, la::Extreme which, double limit) {
  double place = 0;  // of the last switches
  for (int places = 0;;) {
    const auto tangent = system_.tangent_at(ray());
    const auto change = system_.stress_change(ray());
    const auto next = which == la::Extreme::both ? std::nullopt : next_switch();
    const bool new_place = next && *next > place * (1 + one_place);
    stopped_short_ = new_place && places == most_places;
    if (next && !stopped_short_) {
      const double step = std::min(*next, limit) - lambda_;
      const auto before = tangent.plus(step / (2 * h_), change);
      if (is_stable(before)) {
        if (*next > limit) return;
        advance(step);
        if (new_place) place = lambda_, ++places;
        const auto now = system_.tangent_at(ray());
        if (!is_stable(now)) return take_factors_here(before, now, count);
        settle();
        continue;
      }
    }
    pairs_ = la::solve_extreme(change, tangent, count, which);
    for (const double value : pairs_.values) factors_.push_back(lambda_ - 2 * h_ / value);
    return;
  }
}

la::Vector BucklingCourse::response_at(double factor) const {
  la::Vector response = copy_of(way_);
  response.add(factor - lambda_, rate_);
  return response;
}

}  // namespace tautline::steps
