#include <tautline/rod/exact_rod.hpp>

#include <cmath>

#include <rod/arc.hpp>
#include <rod/newton.hpp>
#include <tautline/rod/cantilever_model.hpp>

namespace tautline::rod {

namespace {

/// Where the unknowns are: each node's X, Y, theta, M and R, then M_0, then the lengths if they are free.
struct Layout {
  int links;
  bool free_lengths = false;
  static constexpr int per_node = 5;
  int x(int node) const { return per_node * node; }
  int y(int node) const { return per_node * node + 1; }
  int angle(int node) const { return per_node * node + 2; }
  /// Of node - 1 too: -1 is the root.
  int moment(int node) const { return node < 0 ? per_node * links : per_node * node + 3; }
  int reaction(int node) const { return per_node * node + 4; }
  int length(int link) const { return per_node * links + 1 + link; }
  int size() const { return per_node * links + 1 + (free_lengths ? links : 0); }
};

/// One more condition at a node: residual [m or N, made relative], with its derivatives by X, Y and R.
struct Condition {
  double residual, by_x, by_y, by_reaction;
};

/// A shooting problem: the rod and, node by node, what closes it.
struct Problem {
  const Rod& rod;
  Layout at;
  std::function<std::vector<Condition>(int node, double x, double y, double reaction)> conditions;

  double size() const { return rod.lengths.sum(); }
  double stiffness() const { return rod.bending_stiffness.maxCoeff(); }
};

/// Sizes of the unknowns: length of the rod, 1 rad, moments and forces of a rod bent to its own length.
VecX sizes(const Problem& problem) {
  const Layout& at = problem.at;
  const double length = problem.size(), moment = problem.stiffness() / length;
  VecX size = VecX::Constant(at.size(), length);
  for (int k = 0; k < at.links; ++k) {
    size[at.angle(k)] = 1;
    size[at.moment(k)] = moment;
    size[at.reaction(k)] = moment / length;
  }
  size[at.moment(-1)] = moment;
  return size;
}

/// Ends of link k from values at its beginning: (dx, dy, angle, moment) by (angle, moment, N, length).
Linearised shoot(double bending_stiffness, const Vec<4>& start) {
  const auto end = [&](const VecC& z) -> VecC {
    const auto arc = propagate<Complex>(z[0], z[1] / bending_stiffness, z[2] / bending_stiffness, z[3]);
    return Eigen::Vector4cd(arc.x, arc.y, arc.angle, arc.curvature * bending_stiffness);
  };
  return complex_step(end, start);
}

/// Four equations for each link: it ends where its node is. Relative to the rod's size.
void add_continuity(const Problem& problem, const VecX& z, int k, double axial_force, Linearised& out) {
  const Layout& at = problem.at;
  const Root& root = problem.rod.root;
  const double size = problem.size(), moment = problem.stiffness() / size;
  const Vec<4> scale(1 / size, 1 / size, 1, 1 / moment);
  const double angle = k == 0 ? root.angle : z[at.angle(k - 1)];
  const double length = at.free_lengths ? z[at.length(k)] : problem.rod.lengths[k];
  const Linearised link =
      shoot(problem.rod.bending_stiffness[k], Vec<4>(angle, z[at.moment(k - 1)], axial_force, length));
  const int row = 4 * k;
  const auto rows = [&](int column) { return out.jacobian.col(column).segment<4>(row); };
  Vec<4> gap = link.residual;
  gap[0] += k == 0 ? root.x : z[at.x(k - 1)];
  gap[1] += k == 0 ? root.y : z[at.y(k - 1)];
  if (k > 0) {
    rows(at.x(k - 1))[0] += scale[0];
    rows(at.y(k - 1))[1] += scale[1];
    rows(at.angle(k - 1)) += scale.cwiseProduct(link.jacobian.col(0));
  }
  rows(at.moment(k - 1)) += scale.cwiseProduct(link.jacobian.col(1));
  for (int i = k; i < at.links; ++i) rows(at.reaction(i)) += scale.cwiseProduct(link.jacobian.col(2));
  if (at.free_lengths) rows(at.length(k)) += scale.cwiseProduct(link.jacobian.col(3));
  const int ends[] = {at.x(k), at.y(k), at.angle(k), at.moment(k)};
  for (int i = 0; i < 4; ++i) {
    gap[i] -= z[ends[i]];
    rows(ends[i])[i] -= scale[i];
  }
  out.residual.segment<4>(row) = scale.cwiseProduct(gap);
}

Linearised linearise(const Problem& problem, const VecX& z) {
  const Layout& at = problem.at;
  const int m = at.links;
  Linearised out{VecX::Zero(at.size()), MatX::Zero(at.size(), at.size())};
  double axial_force = 0;
  for (int k = m - 1; k >= 0; --k) {
    axial_force += z[at.reaction(k)];
    add_continuity(problem, z, k, axial_force, out);
  }
  int row = 4 * m;
  for (int k = 0; k < m; ++k) {
    for (const Condition& c : problem.conditions(k, z[at.x(k)], z[at.y(k)], z[at.reaction(k)])) {
      out.residual[row] = c.residual;
      out.jacobian(row, at.x(k)) = c.by_x;
      out.jacobian(row, at.y(k)) = c.by_y;
      out.jacobian(row++, at.reaction(k)) = c.by_reaction;
    }
  }
  const double moment = problem.stiffness() / problem.size();
  out.residual[row] = z[at.moment(m - 1)] / moment;
  out.jacobian(row, at.moment(m - 1)) = 1 / moment;
  return out;
}

SolveSummary solve(const Problem& problem, const ExactOptions& options, VecX& z) {
  return solve_newton([&](const VecX& at) { return linearise(problem, at); }, sizes(problem),
                      options.tolerance, options.max_iterations, z);
}

std::vector<RodPoint> sample(const RodShape& shape) {
  const VecX axial_force = shape.axial_force();
  RodPoint at{0, shape.rod.root.x, shape.rod.root.y, shape.rod.root.angle, shape.moment[0]};
  std::vector<RodPoint> curve{at};
  for (int k = 0; k < shape.rod.links(); ++k) {
    const double ei = shape.rod.bending_stiffness[k], h = shape.rod.lengths[k] / intervals_per_link;
    for (int i = 0; i < intervals_per_link; ++i) {
      const auto arc = propagate<double>(at.angle, at.moment / ei, axial_force[k] / ei, h);
      at = {at.s + h, at.x + arc.x, at.y + arc.y, arc.angle, ei * arc.curvature};
      curve.push_back(at);
    }
  }
  return curve;
}

RodShape make_shape(const Problem& problem, const VecX& z) {
  const Layout& at = problem.at;
  const int m = at.links;
  RodShape shape{problem.rod, VecX(m), VecX(m), VecX(m), VecX(m), VecX(m + 1), {}, {}};
  shape.moment[0] = z[at.moment(-1)];
  for (int k = 0; k < m; ++k) {
    shape.x[k] = z[at.x(k)];
    shape.y[k] = z[at.y(k)];
    shape.angle[k] = z[at.angle(k)];
    shape.reaction[k] = z[at.reaction(k)];
    shape.moment[k + 1] = z[at.moment(k)];
    if (at.free_lengths) shape.rod.lengths[k] = z[at.length(k)];
  }
  shape.moment_of_links = shape.moment;
  if (z.allFinite()) shape.curve = sample(shape);
  return shape;
}

/// Nodes at x, y and angle, reactions and the moments that follow from them.
VecX start_vector(const Problem& problem, const VecX& x, const VecX& y, const VecX& angle,
                  const VecX& reactions) {
  const Layout& at = problem.at;
  VecX z = VecX::Zero(at.size());
  double axial_force = 0;
  for (int k = at.links - 1; k >= 0; --k) {
    const double before = k == 0 ? problem.rod.root.y : y[k - 1];
    axial_force += reactions[k];
    z[at.x(k)] = x[k];
    z[at.y(k)] = y[k];
    z[at.angle(k)] = angle[k];
    z[at.reaction(k)] = reactions[k];
    z[at.moment(k - 1)] = z[at.moment(k)] + axial_force * (y[k] - before);
    if (at.free_lengths) z[at.length(k)] = problem.rod.lengths[k];
  }
  return z;
}

RodSolution finish(SolveSummary summary, RodShape shape, const VecX& slopes) {
  RodSolution solution{std::move(summary), std::move(shape), {}};
  if (solution.summary.converged()) solution.stability = judge_stability(solution.shape, slopes);
  return solution;
}

}  // namespace

RodSolution design_exact(const Umbrella& umbrella, const ExactOptions& options) {
  const bool on_target = options.form == ExactForm::nodes_on_target;
  const double size = umbrella.rod.lengths.sum();
  const auto conditions = [&](int k, double x, double y, double) -> std::vector<Condition> {
    if (on_target)
      return {{(x - umbrella.target_x[k]) / size, 1 / size, 0, 0},
              {(y - umbrella.target_y[k]) / size, 0, 1 / size, 0}};
    const Jet f = umbrella.meridian.at(x);
    return {{(y - f.value) / size, -f.slope / size, 1 / size, 0}};
  };
  const Problem problem{umbrella.rod, {umbrella.rod.links(), on_target}, conditions};
  const RodSolution rough = design_cantilevers(umbrella, {});
  const VecX reactions =
      rough.shape.reaction.allFinite() ? rough.shape.reaction : VecX::Zero(umbrella.rod.links());
  VecX z = start_vector(problem, umbrella.target_x, umbrella.target_y, umbrella.target_angle, reactions);
  SolveSummary summary = solve(problem, options, z);
  RodShape shape = make_shape(problem, z);
  Cables cables = umbrella.cables;
  cables.straight_radius = umbrella.straight_radius(shape.rod.lengths);
  const VecX slopes = cables.slopes(shape.x, shape.reaction);
  return finish(std::move(summary), std::move(shape), slopes);
}

RodSolution load_exact(const Rod& rod, const VecX& reactions, const VecX& start,
                       const ExactOptions& options) {
  const int m = rod.links();
  const double force = rod.bending_stiffness.maxCoeff() / std::pow(rod.lengths.sum(), 2);
  const auto conditions = [&](int k, double, double, double reaction) -> std::vector<Condition> {
    return {{(reaction - reactions[k]) / force, 0, 0, 1 / force}};
  };
  const Problem problem{rod, {m}, conditions};
  VecX x(m), y(m);
  Root at = rod.root;
  for (int k = 0; k < m; ++k) {
    const double mean = (at.angle + start[k]) / 2;
    x[k] = at.x += rod.lengths[k] * std::cos(mean);
    y[k] = at.y += rod.lengths[k] * std::sin(mean);
    at.angle = start[k];
  }
  VecX z = start_vector(problem, x, y, start, reactions);
  SolveSummary summary = solve(problem, options, z);
  return finish(std::move(summary), make_shape(problem, z), VecX::Zero(m));
}

RodSolution turn_exact(const Umbrella& umbrella, const VecX& lengths, const VecX& stiffness,
                       const ExactOptions& options) {
  const int m = umbrella.rod.links();
  Rod rod{lengths, umbrella.rod.bending_stiffness, umbrella.root_at(0)};
  Cables cables = umbrella.cables;
  cables.straight_radius = umbrella.straight_radius(lengths);
  cables.stiffness = stiffness;
  const double unit = rod.bending_stiffness.maxCoeff() / std::pow(lengths.sum(), 2);
  const auto conditions = [&](int k, double x, double, double reaction) -> std::vector<Condition> {
    const Force force = cables.reaction(k, x);
    return {{(reaction - force.value) / unit, -force.slope / unit, 0, 1 / unit}};
  };
  const Problem problem{rod, {m}, conditions};
  const VecX slant = cables.straight_radius * std::tan(umbrella.straight_angle);
  VecX z = start_vector(problem, cables.straight_radius, slant, VecX::Constant(m, umbrella.straight_angle),
                        VecX::Zero(m));
  const auto solve_at = [&](double turn, VecX& there) {
    rod.root = umbrella.root_at(turn);
    return solve(problem, options, there);
  };
  SolveSummary summary = follow_turning(stiffness, solve_at, options.min_step, z);
  rod.root = umbrella.rod.root;
  RodShape shape = make_shape(problem, z);
  VecX slopes(m);
  for (int k = 0; k < m; ++k) slopes[k] = cables.reaction(k, shape.x[k]).slope;
  return finish(std::move(summary), std::move(shape), slopes);
}

}  // namespace tautline::rod
