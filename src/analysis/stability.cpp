#include <tautline/analysis/stability.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace tautline::analysis {

namespace {

/// A start vector that shares no symmetry of the structure, the same in every run.
la::Vector start_vector(const la::Vector& weights, const la::BlockLayout& layout) {
  la::Vector x = la::Vector::like(weights);
  std::vector<double> values;
  for (int i = 3 * layout.first; i < 3 * (layout.first + layout.local); ++i)
    values.push_back(1 + std::sin(12.9898 * (i + 1)));
  x.write(values);
  return x;
}

la::Vector weighed(const la::Vector& x, const la::Vector& weights) {
  la::Vector product = la::Vector::like(x);
  product.copy(x);
  product.multiply_entries(weights);
  return product;
}

}  // namespace

SoftestMode softest_mode(const PathProblem& problem, la::DirectSolver& factored, const la::Vector& weights) {
  constexpr int most = 60;
  constexpr double settled = 1e-12;
  la::Vector x = start_vector(weights, problem.layout()), y = la::Vector::like(x);
  double eigenvalue = 0;
  for (int i = 0; i < most; ++i) {
    la::Vector right = weighed(x, weights);
    x.scale(1 / std::sqrt(x.dot(right)));
    right = weighed(x, weights);
    factored.solve(right, y);
    const double inverse = y.dot(right);
    const double last = eigenvalue;
    eigenvalue = inverse != 0 ? 1 / inverse : 0;
    x.copy(y);
    if (i > 2 && std::abs(eigenvalue - last) <= settled * std::abs(eigenvalue)) break;
  }
  x.scale(1 / std::sqrt(x.dot(weighed(x, weights))));
  return {eigenvalue, std::move(x)};
}

int count_negative(PathProblem& problem, Workspace& workspace) {
  problem.tangent(workspace.tangent);
  workspace.solver.factor(workspace.tangent);
  return workspace.solver.inertia().negative;
}

int count_firmly_negative(PathProblem& problem, Workspace& workspace) {
  constexpr double rounding = 1e-13;  // of the sums |K_ij| over a row: some hundred units in the last place
  problem.tangent(workspace.tangent);
  la::Vector scale(problem.layout());
  scale.write(workspace.tangent.absolute_row_sums_of_blocks());
  if (la::Vector taut(problem.layout()); problem.taut_stiffness(taut)) scale.add(1, taut);
  workspace.tangent.add_diagonal(rounding, scale);
  workspace.solver.factor(workspace.tangent);
  return workspace.solver.inertia().negative;
}

double load_share(const la::Vector& mode, const la::Vector& load_rate, const la::Vector& weights) {
  // The dual norm of the load: its size where displacements are measured by the weights.
  std::vector<double> load(static_cast<std::size_t>(load_rate.local_size())), weight(load.size());
  load_rate.read(load);
  weights.read(weight);
  for (std::size_t i = 0; i < load.size(); ++i) load[i] = weight[i] > 0 ? load[i] / std::sqrt(weight[i]) : 0;
  la::Vector scaled = la::Vector::like(load_rate);
  scaled.write(load);
  const double size = scaled.norm();
  return size > 0 ? mode.dot(load_rate) / size : 0;
}

namespace {

/// Keeps a bracket about the point and proposes where to look next.
class Search {
 public:
  explicit Search(double eigenvalue_at_start) : low_value_(eigenvalue_at_start) {}

  double next() {
    const bool crosses = low_value_ * high_value_ < 0;
    double t = (low_ + high_) / 2;
    if (crosses && rounds_ % 3 != 2)
      t = low_ + (high_ - low_) * std::clamp(low_value_ / (low_value_ - high_value_), 0.01, 0.99);
    ++rounds_;
    return t;
  }
  void before(double t, double eigenvalue) {
    low_ = t;
    low_value_ = eigenvalue;
  }
  void after(double t, double eigenvalue) {
    high_ = t;
    high_value_ = eigenvalue;
  }
  double width() const { return high_ - low_; }
  double high() const { return high_; }

 private:
  double low_ = 0, high_ = 1, low_value_, high_value_ = 0;
  int rounds_ = 0;
};

constexpr double aligned = 1e-4;  // a mode that the load works on by more than this is no bifurcation

}  // namespace

std::optional<CriticalPoint> find_critical_point(PathProblem& problem, Workspace& workspace,
                                                 const Bracket& bracket, double& behind) {
  constexpr int most = 60;
  constexpr double narrow = 1e-11, null = 1e-10;
  la::Vector weights(problem.layout()), load(problem.layout());
  problem.weights(1, weights);
  count_negative(problem, workspace);
  const bool regular = workspace.solver.inertia().null == 0;
  const double at_start = softest_mode(problem, workspace.solver, weights).eigenvalue;
  double scale = std::abs(at_start);  // the largest that was seen: a path may start at a critical point
  Search search(at_start);
  int negative_after = bracket.negative_after;
  std::optional<CriticalPoint> found;
  for (int i = 0; i < most && search.width() > narrow; ++i) {
    const double t = search.next();
    const auto lambda = bracket.go(t);
    if (!lambda) break;
    const int negative = count_negative(problem, workspace);
    // Met exactly, the first point leaves a null pivot, which the factors pass over: those of a tangent
    // beside it have its mode.
    if (regular && negative == bracket.negative_before && workspace.solver.inertia().null > 0)
      count_firmly_negative(problem, workspace);
    SoftestMode soft = softest_mode(problem, workspace.solver, weights);
    problem.load_rate(load);
    scale = std::max(scale, std::abs(soft.eigenvalue));
    const double share = load_share(soft.mode, load, weights), relative = soft.eigenvalue / scale;
    if (!found || std::abs(relative) < std::abs(found->eigenvalue))
      found.emplace(CriticalPoint{
          std::abs(share) > aligned ? CriticalPoint::Kind::limit : CriticalPoint::Kind::bifurcation, *lambda,
          bracket.negative_before, negative_after, relative, std::abs(share), std::move(soft.mode),
          problem.keep()});
    if (negative == bracket.negative_before) {
      search.before(t, soft.eigenvalue);
    } else {
      search.after(t, soft.eigenvalue);
      negative_after = negative;
    }
    if (std::abs(relative) < null) break;
  }
  if (found) found->negative_after = negative_after;
  behind = search.high();
  return found;
}

}  // namespace tautline::analysis
