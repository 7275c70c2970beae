#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tautline/core/error.hpp>
#include <tautline/la/direct_solver.hpp>
#include <tautline/la/eigen_solver.hpp>
#include <utility>

#include "la/check.hpp"
#include "la/eigen_problem.hpp"
#include "la/eigen_refinement.hpp"

namespace tautline::la {

namespace {

void configure(::EPS eps, const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
               double shift) {
  set_problem(eps, stiffness, mass, count);
  check(EPSSetTarget(eps, shift), "EPSSetTarget");
  check(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE), "EPSSetWhichEigenpairs");
  ::ST transform = nullptr;
  check(EPSGetST(eps, &transform), "EPSGetST");
  check(STSetType(transform, STSINVERT), "STSetType");
}

/// Whether a vector moves no mass: that of an eigenvalue at infinity, whatever number stands for it.
bool moves_no_mass(const SymmetricMatrix& mass, ::Vec x) {
  constexpr double none = 1e-14;  // of what its unknowns could move
  ::Vec product = nullptr;
  check(VecDuplicate(x, &product), "VecDuplicate");
  const Vector owner = Vector::adopt(product);
  PetscReal largest = 0, length = 0;
  PetscScalar moved = 0;
  check(MatMult(mass.handle(), x, product), "MatMult");
  check(MatNorm(mass.handle(), NORM_INFINITY, &largest), "MatNorm");
  check(VecNorm(x, NORM_2, &length), "VecNorm");
  check(VecDot(x, product, &moved), "VecDot");
  return !(moved > none * largest * length * length);
}

/// Up to `count` pairs nearest to the shift that SLEPc finds outside the space of those known and found, put
/// to the latter.
void find_more(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count, double shift,
               const std::vector<Vector>& known, EigenPairs& pairs) {
  const EigenHandle eps;
  configure(eps.get(), stiffness, mass, count, shift);
  std::vector<::Vec> space;
  for (const auto& vector : known) space.push_back(vector.handle());
  for (const auto& vector : pairs.vectors) space.push_back(vector.handle());
  if (!space.empty())
    check(EPSSetDeflationSpace(eps.get(), static_cast<PetscInt>(space.size()), space.data()),
          "EPSSetDeflationSpace");
  check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  for (int i = 0; i < std::min<int>(count, converged); ++i) {
    ::Vec x = nullptr;
    check(MatCreateVecs(stiffness.handle(), &x, nullptr), "MatCreateVecs");
    Vector vector = Vector::adopt(x);
    PetscScalar value = 0;
    check(EPSGetEigenpair(eps.get(), i, &value, nullptr, x, nullptr), "EPSGetEigenpair");
    if (moves_no_mass(mass, x)) continue;
    pairs.values.push_back(value);
    pairs.vectors.push_back(std::move(vector));
    pairs.residuals.push_back(0);
  }
}

/// Number of eigenvalues below `value`, up to a constant: the negative pivots of K - value M (Sylvester's
/// law).
int count_below(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double value) {
  const SymmetricMatrix shifted = stiffness.plus(-value, mass);
  DirectSolver solver;
  if (!solver.factor(shifted)) throw LibraryError("the count of modes failed: " + solver.failure());
  return solver.inertia().negative;
}

int count_within(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double shift, double radius) {
  return count_below(stiffness, mass, shift + radius) - count_below(stiffness, mass, shift - radius);
}

/// Puts pairs in this order and keeps the first `count`.
void arrange(EigenPairs& pairs, int count, const std::function<bool(double, double)>& before) {
  std::vector<std::size_t> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return before(pairs.values[a], pairs.values[b]); });
  order.resize(std::min(order.size(), static_cast<std::size_t>(count)));
  EigenPairs kept;
  for (const std::size_t i : order) {
    kept.values.push_back(pairs.values[i]);
    kept.vectors.push_back(std::move(pairs.vectors[i]));
    kept.residuals.push_back(pairs.residuals[i]);
  }
  pairs = std::move(kept);
}

[[noreturn]] void too_few(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                          double shift, std::size_t known, const EigenPairs& pairs) {
  constexpr double far = 1e6;
  const auto found = static_cast<int>(pairs.values.size());
  const auto sentence = fmt::format("SLEPc found {} of the {} modes asked for", found, count);
  if (found == 0) throw LibraryError(sentence + ": check that the structure has mass");
  const double radius = far * std::abs(pairs.values.back() - shift);
  if (count_within(stiffness, mass, shift, radius) > found + static_cast<int>(known))
    throw LibraryError(sentence + ": ask for fewer");
  throw ModelError(
      fmt::format("only {} of the {} modes asked for exist: no more unknowns have a mass of their own. Ask "
                  "for at most {}",
                  found, count, found));
}

}  // namespace

EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                           double shift, const std::vector<Vector>& known) {
  constexpr int most_rounds = 12, spare = 2;
  EigenPairs pairs;
  for (int round = 0, more = count + spare; round < most_rounds; ++round) {
    find_more(stiffness, mass, more, shift, known, pairs);
    arrange(pairs, count + most_rounds * (count + spare),
            [&](double a, double b) { return std::abs(a - shift) < std::abs(b - shift); });
    if (static_cast<int>(pairs.values.size()) < count)
      too_few(stiffness, mass, count, shift, known.size(), pairs);
    std::vector<double> distances;
    for (const double value : pairs.values) distances.push_back(std::abs(value - shift));
    const Gap gap = gap_behind(distances, count);
    more = count_within(stiffness, mass, shift, gap.place) - static_cast<int>(known.size()) - gap.before;
    if (more > 0) continue;
    arrange(pairs, count, [&](double a, double b) { return std::abs(a - shift) < std::abs(b - shift); });
    arrange(pairs, count, std::less<>());
    refine(stiffness, mass, shift, known, pairs);
    return pairs;
  }
  throw LibraryError(
      "SLEPc did not find every mode of a cluster of equal frequencies: ask for more or fewer modes");
}

}  // namespace tautline::la
