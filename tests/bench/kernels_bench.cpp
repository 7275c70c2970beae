// Time of one call of each element kernel, force only (0) and with tangent (1).
#include <benchmark/benchmark.h>

#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/membrane.hpp>

namespace tautline::element {
namespace {

Want want_of(const benchmark::State& state) {
  return state.range(0) == 0 ? Want::force : Want::tangent;
}

void cable(benchmark::State& state) {
  Mat<3, 2> x;
  x << 0, 0.08, 0, 0.01, 0, 0.002;
  const Vec<6> u = 1e-3 * Vec<6>::LinSpaced(0, 1);
  for (auto _ : state) benchmark::DoNotOptimize(evaluate_cable({30890, 3e-4}, x, u, want_of(state)));
}
BENCHMARK(cable)->Arg(0)->Arg(1);

void membrane(benchmark::State& state) {
  Mat<3, 3> x;
  x << 0, 0.08, 0.04, 0, 0, 0.07, 0, 0.002, 0.001;
  const Vec<9> u = 1e-3 * Vec<9>::LinSpaced(0, 1);
  for (auto _ : state)
    benchmark::DoNotOptimize(evaluate_membrane({130, 0.3, 0.01}, Vec3(2, 2, 0), x, u, want_of(state)));
}
BENCHMARK(membrane)->Arg(0)->Arg(1);

void beam(benchmark::State& state) {
  BeamGeometry geometry;
  geometry.x_ref << 0, 0.08, 0, 0.01, 0, 0.002;
  geometry.frame = beam_frame(geometry.x_ref, Vec3(0, 0, 1));
  BeamMotion motion;
  motion.u << 0.01, 0.0101, -0.02, -0.0201, 0.005, 0.0052;
  const BeamSection section{9e7, 18750, 607, 800, 0, 0, 0.86, 1e-4, 1e-4};
  for (auto _ : state) benchmark::DoNotOptimize(evaluate_beam(section, geometry, motion, want_of(state)));
}
BENCHMARK(beam)->Arg(0)->Arg(1);

}  // namespace
}  // namespace tautline::element

BENCHMARK_MAIN();
