#include <fmt/format.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
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

/// The `count` pairs nearest to the shift that SLEPc finds outside the space of `known`.
EigenPairs find_pairs(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count, double shift,
                      const std::vector<Vector>& known) {
  const EigenHandle eps;
  configure(eps.get(), stiffness, mass, count, shift);
  std::vector<::Vec> space;
  for (const auto& vector : known) space.push_back(vector.handle());
  if (!space.empty())
    check(EPSSetDeflationSpace(eps.get(), static_cast<PetscInt>(space.size()), space.data()),
          "EPSSetDeflationSpace");
  check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  if (converged < count)
    throw LibraryError(fmt::format(
        "SLEPc found {} of the {} modes asked for: ask for fewer, or check that the structure has mass",
        static_cast<int>(converged), count));
  EigenPairs pairs;
  for (int i = 0; i < count; ++i) {
    ::Vec x = nullptr;
    check(MatCreateVecs(stiffness.handle(), &x, nullptr), "MatCreateVecs");
    PetscScalar value = 0;
    check(EPSGetEigenpair(eps.get(), i, &value, nullptr, x, nullptr), "EPSGetEigenpair");
    pairs.values.push_back(value);
    pairs.vectors.push_back(Vector::adopt(x));
    pairs.residuals.push_back(0);
  }
  return pairs;
}

/// Number of eigenvalues below `value`, up to a constant: the negative pivots of K - value M (Sylvester's
/// law).
int count_below(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double value) {
  const SymmetricMatrix shifted = stiffness.plus(-value, mass);
  DirectSolver solver;
  if (!solver.factor(shifted)) throw LibraryError("the count of modes failed: " + solver.failure());
  return solver.inertia().negative;
}

/// How many eigenvalues lie nearer to the shift than the farthest one found and are not among those found:
/// copies of multiple ones, which one Krylov sequence meets by round-off only.
int count_missing(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, const EigenPairs& pairs,
                  double shift) {
  double radius = 0;
  for (const double value : pairs.values) radius = std::max(radius, std::abs(value - shift));
  radius *= 1 - 1e-8;
  if (radius == 0) return 0;
  const auto found = std::count_if(pairs.values.begin(), pairs.values.end(),
                                   [&](double value) { return std::abs(value - shift) < radius; });
  return count_below(stiffness, mass, shift + radius) - count_below(stiffness, mass, shift - radius) -
         static_cast<int>(found);
}

/// Puts `more` to `pairs` and keeps the `count` nearest to the shift, smallest first.
void merge(EigenPairs& pairs, EigenPairs more, int count, double shift) {
  for (std::size_t i = 0; i < more.values.size(); ++i) {
    pairs.values.push_back(more.values[i]);
    pairs.vectors.push_back(std::move(more.vectors[i]));
    pairs.residuals.push_back(more.residuals[i]);
  }
  std::vector<std::size_t> order(pairs.values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(pairs.values[a] - shift) < std::abs(pairs.values[b] - shift);
  });
  order.resize(static_cast<std::size_t>(count));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return pairs.values[a] < pairs.values[b]; });
  EigenPairs kept;
  for (const std::size_t i : order) {
    kept.values.push_back(pairs.values[i]);
    kept.vectors.push_back(std::move(pairs.vectors[i]));
    kept.residuals.push_back(pairs.residuals[i]);
  }
  pairs = std::move(kept);
}

}  // namespace

EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                           double shift) {
  constexpr int most_rounds = 8;
  EigenPairs pairs;
  merge(pairs, find_pairs(stiffness, mass, count, shift, {}), count, shift);
  for (int round = 0; round < most_rounds; ++round) {
    const int missing = count_missing(stiffness, mass, pairs, shift);
    if (missing <= 0) {
      refine(stiffness, mass, shift, pairs);
      return pairs;
    }
    merge(pairs, find_pairs(stiffness, mass, missing, shift, pairs.vectors), count, shift);
  }
  throw LibraryError(
      "SLEPc did not find every mode of a cluster of equal frequencies: ask for more or fewer modes");
}

}  // namespace tautline::la
