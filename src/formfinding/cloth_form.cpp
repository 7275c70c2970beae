#include <formfinding/cloth_form.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/film_sides.hpp>
#include <limits>
#include <map>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

constexpr int most_shapes = 100;
constexpr double settled = 1e-12;  // change of the cloth's pull over its largest, of which no more is made

void check_cloth(const ConstrainedNet& problem) {
  const int n_nodes = static_cast<int>(problem.net.nodes.size());
  if (problem.surface_stress.size() != static_cast<Eigen::Index>(problem.triangles.size()))
    throw ModelError(fmt::format("{} triangles of cloth, but {} surface stresses", problem.triangles.size(),
                                 problem.surface_stress.size()));
  for (const auto& corners : problem.triangles)
    for (const int node : corners)
      if (node < 0 || node >= n_nodes)
        throw ModelError(fmt::format("cloth names node {}, but the net has {} nodes", node + 1, n_nodes));
  check_areas(problem.net, isotropic_film(problem.triangles, problem.surface_stress));
}

/// The net with every side of the cloth as a branch of a held force density.
class ClothedNet {
 public:
  explicit ClothedNet(const ConstrainedNet& problem, const ConstrainedOptions& options)
      : problem_(problem),
        facets_(isotropic_film(problem.triangles, problem.surface_stress)),
        sides_(find_sides(facets_)),
        net_(problem) {
    net_.triangles.clear();
    net_.net.branches.insert(net_.net.branches.end(), sides_.nodes.begin(), sides_.nodes.end());
    const auto n = static_cast<Eigen::Index>(net_.net.branches.size());
    net_.held.resize(problem.net.branches.size(), false);
    net_.held.resize(net_.net.branches.size(), true);
    if (!net_.pulls.empty()) net_.pulls.resize(net_.net.branches.size(), false);
    net_.force_density = VecX::Constant(n, options.initial_force_density);
    if (problem.force_density.size() > 0) net_.force_density.head(n_cables()) = problem.force_density;
    extend(net_.lower, n);
    extend(net_.upper, n);
    if (problem.axial_stiffness.size() > 0) {
      net_.axial_stiffness = VecX::Ones(n);
      net_.axial_stiffness.head(n_cables()) = problem.axial_stiffness;
    }
  }

  const ConstrainedNet& net() const noexcept { return net_; }
  Eigen::Index n_cables() const { return static_cast<Eigen::Index>(problem_.net.branches.size()); }

  VecX pull(const Points& nodes) const {
    return natural_force_density(sides_, facets_, to_coordinates(nodes));
  }

  /// Goes on from a shape with the pull of the cloth there.
  void continue_from(const ConstrainedResult& found, const VecX& pull) {
    net_.net.nodes = found.nodes;
    net_.force_density.head(n_cables()) = found.force_density.head(n_cables());
    set_pull(pull);
  }
  void set_pull(const VecX& pull) { net_.force_density.tail(pull.size()) = pull; }

  /// The answer without the sides of the cloth.
  void strip(ConstrainedResult& found) const {
    for (VecX* values : {&found.force_density, &found.tension, &found.length, &found.unstressed_length})
      if (values->size() > 0) values->conservativeResize(n_cables());
    // A side opposite to an obtuse corner is pressed, which is no cable's trouble.
    if (found.force_density.size() == 0 || found.force_density.minCoeff() >= 0) found.warnings.clear();
  }

  /// Pull of the cloth along the cables; that along sides without a cable is left out.
  VecX along_cables(const VecX& pull) const {
    std::map<std::array<int, 2>, double> by_ends;
    for (std::size_t i = 0; i < sides_.nodes.size(); ++i)
      by_ends[sorted(sides_.nodes[i])] = pull[static_cast<Eigen::Index>(i)];
    VecX result = VecX::Zero(n_cables());
    for (Eigen::Index b = 0; b < result.size(); ++b)
      if (const auto it = by_ends.find(sorted(problem_.net.branches[static_cast<std::size_t>(b)]));
          it != by_ends.end())
        result[b] = it->second;
    return result;
  }

 private:
  static std::array<int, 2> sorted(const std::array<int, 2>& ends) {
    return {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  }
  void extend(VecX& bounds, Eigen::Index n) const {
    if (bounds.size() == 0) return;
    const VecX own = bounds;
    bounds = VecX::Constant(n, std::nan(""));
    bounds.head(own.size()) = own;
  }

  const ConstrainedNet& problem_;
  std::vector<FilmFacet> facets_;
  FilmSides sides_;
  ConstrainedNet net_;
};

}  // namespace

ConstrainedResult find_form_with_cloth(const ConstrainedNet& problem, const ConstrainedOptions& options) {
  check_cloth(problem);
  ClothedNet clothed(problem, options);
  VecX pull = clothed.pull(problem.net.nodes);
  clothed.set_pull(pull);
  ConstrainedResult found;
  double change = 0, last = std::numeric_limits<double>::infinity();
  int shapes = 0, iterations = 0;
  std::vector<double> residual;
  while (shapes < most_shapes) {
    found = find_form(clothed.net(), options);
    ++shapes;
    iterations += found.iterations;
    residual.insert(residual.end(), found.residual.begin(), found.residual.end());
    if (!found.converged && !found.least_squares_optimum) break;
    const VecX next = clothed.pull(found.nodes);
    change = (next - pull).cwiseAbs().maxCoeff() / next.cwiseAbs().maxCoeff();
    if (change <= settled || (change <= 100 * settled && change >= last)) break;
    last = change;
    pull = next;
    clothed.continue_from(found, pull);
  }
  clothed.strip(found);
  found.iterations = iterations;
  found.residual = std::move(residual);
  found.cloth_iterations = shapes;
  found.cloth_force_density = clothed.along_cables(pull);
  if (change > 1e-9) {
    found.converged = found.in_balance = false;
    found.reason = fmt::format(
        "the pull of the cloth still changes by {:.3g} of itself > 1e-9 after {} shapes", change, shapes);
  }
  return found;
}

}  // namespace tautline::formfinding
