#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <slepceps.h>

#include <tautline/core/error.hpp>
#include <tautline/la/eigen_solver.hpp>

#include "la/check.hpp"
#include "la/eigen_problem.hpp"

namespace tautline::la {

namespace {

constexpr double nothing = 1e-10;  // eigenvalues below this part of the largest are zero

double quotient(const SymmetricMatrix& a, const std::vector<double>& x) {
  const auto ax = a.multiply_extended(x);
  long double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += ax[i] * x[i];
  return static_cast<double>(sum);
}

/// Puts a pair to the others with its Rayleigh quotient and residual.
void append(EigenPairs& pairs, const SymmetricMatrix& a, const SymmetricMatrix& b, Vector vector) {
  std::vector<double> x;
  vector.gather(x);
  const double size = std::sqrt(quotient(b, x));
  vector.scale(1 / size);
  for (double& entry : x) entry /= size;
  const double value = quotient(a, x);
  const auto ax = a.multiply_extended(x), bx = b.multiply_extended(x);
  long double rest = 0, length = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const long double r = ax[i] - value * bx[i];
    rest += r * r;
    length += static_cast<long double>(x[i]) * x[i];
  }
  pairs.values.push_back(value);
  pairs.residuals.push_back(static_cast<double>(std::sqrt(rest / length)) /
                            (std::abs(value) * b.norm_of_diagonal()));
  pairs.vectors.push_back(std::move(vector));
}

EPSWhich which_of(Extreme which) {
  if (which == Extreme::both) return EPS_LARGEST_MAGNITUDE;
  return which == Extreme::lowest ? EPS_SMALLEST_REAL : EPS_LARGEST_REAL;
}

bool counts(double value, Extreme which) {
  return which == Extreme::both || (which == Extreme::lowest ? value < 0 : value > 0);
}

/// Pairs that SLEPc finds outside the space of those known, put to them.
void find_more(const SymmetricMatrix& a, const SymmetricMatrix& b, int count, Extreme which,
               EigenPairs& pairs) {
  const EigenHandle eps;
  set_problem(eps.get(), a, b, count);
  check(EPSSetWhichEigenpairs(eps.get(), which_of(which)), "EPSSetWhichEigenpairs");
  std::vector<::Vec> space;
  for (const auto& vector : pairs.vectors) space.push_back(vector.handle());
  if (!space.empty())
    check(EPSSetDeflationSpace(eps.get(), static_cast<PetscInt>(space.size()), space.data()),
          "EPSSetDeflationSpace");
  check(EPSSolve(eps.get()), "EPSSolve");
  PetscInt converged = 0;
  check(EPSGetConverged(eps.get(), &converged), "EPSGetConverged");
  double largest = 0;
  for (const double value : pairs.values) largest = std::max(largest, std::abs(value));
  for (int i = 0; i < std::min<int>(count, converged); ++i) {
    ::Vec x = nullptr;
    check(MatCreateVecs(b.handle(), &x, nullptr), "MatCreateVecs");
    Vector vector = Vector::adopt(x);
    PetscScalar value = 0;
    check(EPSGetEigenpair(eps.get(), i, &value, nullptr, x, nullptr), "EPSGetEigenpair");
    largest = std::max(largest, std::abs(value));
    if (counts(value, which) && std::abs(value) > nothing * largest) append(pairs, a, b, std::move(vector));
  }
}

int count_below(const SymmetricMatrix& a, const SymmetricMatrix& b, double value) {
  const SymmetricMatrix shifted = b.plus(-1 / value, a);  // times -value, which is what counts
  DirectSolver solver;
  if (!solver.factor(shifted)) throw LibraryError("the count of modes failed: " + solver.failure());
  return solver.inertia().negative;
}

/// How many eigenvalues are farther from zero than `place`: the negative pivots of B - A / s are those beyond
/// s, on the side of s.
int count_beyond(const SymmetricMatrix& a, const SymmetricMatrix& b, double place, Extreme which) {
  int all = 0;
  if (which != Extreme::highest) all += count_below(a, b, -place);
  if (which != Extreme::lowest) all += count_below(a, b, place);
  return all;
}

void sort_and_cut(EigenPairs& pairs, int count) {
  std::vector<std::size_t> order(pairs.values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::abs(pairs.values[i]) > std::abs(pairs.values[j]);
  });
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(count)));
  EigenPairs kept;
  for (const std::size_t i : order) {
    kept.values.push_back(pairs.values[i]);
    kept.residuals.push_back(pairs.residuals[i]);
    kept.vectors.push_back(std::move(pairs.vectors[i]));
  }
  pairs = std::move(kept);
}

}  // namespace

EigenPairs solve_extreme(const SymmetricMatrix& a, const SymmetricMatrix& b, int count, Extreme which) {
  constexpr int most_rounds = 12, spare = 2;
  EigenPairs pairs;
  for (int round = 0, more = count + spare; round < most_rounds; ++round) {
    find_more(a, b, more, which, pairs);
    sort_and_cut(pairs, count + most_rounds * (count + spare));
    if (pairs.values.empty()) return pairs;
    std::vector<double> sizes;
    for (const double value : pairs.values) sizes.push_back(std::abs(value));
    const Gap gap = gap_behind(sizes, count);
    more = count_beyond(a, b, gap.place, which) - gap.before;
    if (more > 0) continue;
    sort_and_cut(pairs, count);
    return pairs;
  }
  throw LibraryError(
      "SLEPc did not find every mode of a cluster of equal factors: ask for more or fewer modes");
}

}  // namespace tautline::la
