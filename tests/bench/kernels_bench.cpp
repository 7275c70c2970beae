// Time of one call of each element kernel, force only (0) and with tangent (1).
#include <benchmark/benchmark.h>

#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/catenary.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/element/pressure.hpp>
#include <tautline/element/shell.hpp>
#include <tautline/element/spring.hpp>

namespace tautline::element {
namespace {

Want want_of(const benchmark::State& state) {
  return state.range(0) == 0 ? Want::force : Want::tangent;
}

/// Times `kernel`; reports the elements done in a second.
template <class Kernel>
void repeat(benchmark::State& state, const Kernel& kernel) {
  for (auto _ : state) benchmark::DoNotOptimize(kernel());
  state.SetItemsProcessed(state.iterations());
}

void cable(benchmark::State& state) {
  Mat<3, 2> x;
  x << 0, 0.08, 0, 0.01, 0, 0.002;
  const Vec<6> u = 1e-3 * Vec<6>::LinSpaced(0, 1);
  repeat(state, [&] { return evaluate_cable({30890, 3e-4}, x, u, want_of(state)); });
}
BENCHMARK(cable)->Arg(0)->Arg(1);

/// Unstressed length / chord in thousandths: taut, of the same length, slack.
void catenary(benchmark::State& state) {
  Mat<3, 2> x;
  x << 0, 8, 0, 1, 0, 2;
  const Vec<6> u = 1e-3 * Vec<6>::LinSpaced(0, 1);
  const CatenaryProperties properties{1e6, 1e-3 * state.range(1) * (x.col(1) - x.col(0)).norm(), 1};
  repeat(state, [&] { return evaluate_catenary(properties, Vec3(0, 0, -9.81), x, u, want_of(state)); });
}
BENCHMARK(catenary)->ArgsProduct({{0, 1}, {995, 1000, 1100}});

void spring(benchmark::State& state) {
  const SpringProperties properties{{300, 200, 50}, {30, 10, 20}};
  SpringMotion motion;
  motion.u << 0.01, 0.0101, -0.02, -0.0201, 0.005, 0.0052;
  motion.rotation[1] = Eigen::AngleAxisd(0.02, Vec3::UnitZ()).toRotationMatrix();
  repeat(state, [&] { return evaluate_spring(properties, motion, want_of(state)); });
}
BENCHMARK(spring)->Arg(0)->Arg(1);

/// Corners of a facet that is not flat; a triangle takes the first three.
template <int N>
Mat<3, N> facet() {
  Mat<3, 4> x;
  x << 0, 0.08, 0.09, 0.01, 0, 0, 0.07, 0.06, 0, 0.002, 0.001, 0.003;
  return x.leftCols<N>();
}

template <int N>
void membrane_under(benchmark::State& state, const MembraneSection& section, const Vec3& prestress) {
  const Mat<3, N> x = facet<N>();
  const MembraneLaw law = membrane_law(section, 0.3, prestress, 0);
  const Vec<3 * N> u = 1e-3 * Vec<3 * N>::LinSpaced(0, 1);
  repeat(state, [&] { return evaluate_membrane<N>(law, x, u, want_of(state)); });
}

template <int N>
void membrane(benchmark::State& state) {
  membrane_under<N>(state, {130, 0.3, 0.01}, Vec3(2, 2, 0));
}
BENCHMARK(membrane<3>)->Arg(0)->Arg(1);
BENCHMARK(membrane<4>)->Arg(0)->Arg(1);

template <int N>
void membrane_wrinkled(benchmark::State& state) {
  membrane_under<N>(state, {130, 0.3, 0.01, 40, 15, 0, 0, true}, Vec3(2, -2, 0.5));
}
BENCHMARK(membrane_wrinkled<3>)->Arg(0)->Arg(1);
BENCHMARK(membrane_wrinkled<4>)->Arg(0)->Arg(1);

template <int N>
void pressure(benchmark::State& state) {
  const Mat<3, N> x = facet<N>();
  repeat(state, [&] { return evaluate_pressure<N>(100, x, want_of(state)); });
}
BENCHMARK(pressure<3>)->Arg(0)->Arg(1);
BENCHMARK(pressure<4>)->Arg(0)->Arg(1);

void beam(benchmark::State& state) {
  BeamGeometry geometry;
  geometry.x_ref << 0, 0.08, 0, 0.01, 0, 0.002;
  geometry.frame = beam_frame(geometry.x_ref, Vec3(0, 0, 1));
  BeamMotion motion;
  motion.u << 0.01, 0.0101, -0.02, -0.0201, 0.005, 0.0052;
  const BeamSection section{9e7, 18750, 607, 800, 0, 0, 0.86, 1e-4, 1e-4};
  repeat(state, [&] { return evaluate_beam(section, geometry, motion, want_of(state)); });
}
BENCHMARK(beam)->Arg(0)->Arg(1);

template <int N>
void shell(benchmark::State& state) {
  Mat<3, 4> x, u;
  x << 0, 0.08, 0.09, 0.01, 0, 0.005, 0.08, 0.07, 0, 0.001, 0.003, 0.002;
  u << 0, 1e-4, 2e-4, 1e-4, 0, 1e-4, -1e-4, 2e-4, 0, 1e-3, 2e-3, 1e-3;
  ShellGeometry<N> geometry;
  ShellMotion<N> motion;
  geometry.x_ref = x.leftCols<N>();
  geometry.director = shell_frame<N>(geometry.x_ref).col(2).template replicate<1, N>();
  motion.u = u.leftCols<N>();
  for (int i = 0; i < N; ++i)
    motion.rotation[i] = Eigen::AngleAxisd(0.01 * (i + 1), Vec3(0.6, 0.8, 0)).toRotationMatrix();
  const ShellSection section{2.1e11, 0.3, 1e-3, 7850, 5. / 6, 0};
  repeat(state, [&] { return evaluate_shell<N>(section, geometry, motion, want_of(state)); });
}
BENCHMARK(shell<3>)->Name("shell3")->Arg(0)->Arg(1);
BENCHMARK(shell<4>)->Name("shell4")->Arg(0)->Arg(1);

}  // namespace
}  // namespace tautline::element

BENCHMARK_MAIN();
