// Time of form-finding: a hexagonal net on a paraboloid with a round edge, all cables at one tension.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <formfinding/nets.hpp>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

/// Net of diameter 12 m on a dish of focal length 8 m.
Net round_net(int rings, const Dish& dish) {
  Net net = triangular_net(rings, 6.0 / rings, dish);
  for (std::size_t i = 0; i < net.nodes.size(); ++i) {
    if (!net.fixed[i]) continue;
    const Vec3 p = 6 * Vec3(net.nodes[i].x(), net.nodes[i].y(), 0).normalized();
    net.nodes[i] = Vec3(p.x(), p.y(), dish.height(p.x(), p.y()));
  }
  return net;
}

void find_one_tension(benchmark::State& state, TensionMethod method) {
  const Dish dish(8);
  const Net net = round_net(static_cast<int>(state.range(0)), dish);
  const VecX tension = VecX::Constant(static_cast<Eigen::Index>(net.branches.size()), 10);
  ForceDensityOptions options;
  options.method = method;
  options.tolerance = 1e-7;
  for (auto _ : state) {
    const ForceDensityResult result = find_tensions(net, tension, &dish, options);
    if (!result.converged) state.SkipWithError(result.reason.c_str());
  }
  state.counters["cables"] = static_cast<double>(net.branches.size());
  state.SetComplexityN(static_cast<int>(net.branches.size()));
}

double seconds_of(const ConstrainedNet& problem, const ConstrainedOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  benchmark::DoNotOptimize(find_form(problem, options));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One iteration of the same Newton loop with the pseudo-inverse of the dense Jacobian (complete orthogonal
/// decomposition), beside the whole sparse solve in the same run. Counters: seconds of the sparse solve to
/// its end by positions and by LSQR, and the dense iteration's time over each.
void one_dense_iteration(benchmark::State& state) {
  const Dish dish(8);
  ConstrainedNet problem;
  problem.net = round_net(static_cast<int>(state.range(0)), dish);
  problem.surface = &dish;
  Constraint tension{ConstraintKind::tension, "net", {}, {10.0}};
  for (std::size_t b = 0; b < problem.net.branches.size(); ++b)
    tension.members.push_back(static_cast<int>(b));
  problem.constraints = {tension};
  ConstrainedOptions options;
  options.tolerance = 1e-7;
  options.step_solver = StepSolver::position_newton;
  const double by_positions = seconds_of(problem, options);
  options.step_solver = StepSolver::lsqr;
  const double by_lsqr = seconds_of(problem, options);
  options.step_solver = StepSolver::dense;
  options.max_iterations = 1;
  double dense = 0;
  for (auto _ : state) dense = seconds_of(problem, options);
  state.counters["cables"] = static_cast<double>(problem.net.branches.size());
  state.counters["positions_s"] = by_positions;
  state.counters["lsqr_s"] = by_lsqr;
  state.counters["over_positions"] = dense / by_positions;
  state.counters["over_lsqr"] = dense / by_lsqr;
}

BENCHMARK(one_dense_iteration)->Arg(5)->Arg(10)->Arg(20)->Unit(benchmark::kMillisecond)->Iterations(1);

BENCHMARK_CAPTURE(find_one_tension, position_newton, TensionMethod::position_newton)
    ->RangeMultiplier(2)
    ->Range(10, 160)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Complexity();
BENCHMARK_CAPTURE(find_one_tension, fixed_point, TensionMethod::fixed_point)
    ->RangeMultiplier(2)
    ->Range(10, 80)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(find_one_tension, step_of_smallest_norm, TensionMethod::step_of_smallest_norm)
    ->RangeMultiplier(2)
    ->Range(10, 40)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace tautline::formfinding

BENCHMARK_MAIN();
