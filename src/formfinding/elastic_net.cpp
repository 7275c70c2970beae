#include <tautline/formfinding/elastic_net.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/elastic_tangent.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>

namespace tautline::formfinding {

namespace {

constexpr int max_halvings = 10;
constexpr double first_shift = 1e-3, largest_shift = 1e3;  // of the stiffness at each node

/// What the branches' tensions have stored, less the work of the loads; of films nothing [J].
double energy(const ElasticNet& net, const Coordinates& nodes) {
  double sum = 0;
  const Coordinates vectors = branch_vectors(net.net, nodes);
  for (int b = 0; b < vectors.rows(); ++b) {
    const double length = vectors.row(b).norm();
    const BranchForce force = branch_force(net, b, length);
    if (is_elastic(net, b))
      sum += 0.5 * force.tension * (length - net.unstressed_length[b]);  // slack: no tension
    else
      sum += (force.stiffness != 0 ? 0.5 : 1) * force.tension * length;  // a force density, or a tension
  }
  for (std::size_t i = 0; i < net.net.load.size(); ++i) sum -= net.net.load[i].dot(nodes.row(i).transpose());
  return sum;
}

class ElasticSearch {
 public:
  ElasticSearch(const ElasticNet& net, const ElasticOptions& options)
      : net_(net), options_(options), tangent_(net), nodes_(to_coordinates(net.net.nodes)) {
    evaluate();
  }
  ElasticResult run();

 private:
  void evaluate() {
    now_ = net_forces(net_, nodes_);
    free_force_ = now_.force(tangent_.free_nodes(), Eigen::all);
  }
  double largest() const { return free_force_.rows() > 0 ? free_force_.rowwise().norm().maxCoeff() : 0.0; }
  bool take_step();
  bool descend(const Coordinates& dx);

  const ElasticNet& net_;
  const ElasticOptions& options_;
  ElasticTangent tangent_;
  Coordinates nodes_, free_force_;
  NetForces now_;
  ElasticResult result_;
};

bool ElasticSearch::descend(const Coordinates& dx) {
  // Either the energy falls as the slope promises, or, where the energy is rounding only, the force does.
  const double slope = -free_force_.cwiseProduct(dx).sum(), before = energy(net_, nodes_),
               norm = free_force_.norm();
  const Coordinates start = nodes_;
  for (int i = 0; i <= max_halvings; ++i) {
    const double alpha = std::ldexp(1.0, -i);
    for (int k = 0; k < tangent_.n_free(); ++k)
      nodes_.row(tangent_.free_nodes()[k]) = start.row(tangent_.free_nodes()[k]) + alpha * dx.row(k);
    evaluate();
    if (energy(net_, nodes_) <= before + 1e-4 * alpha * slope || free_force_.norm() < 0.5 * norm) return true;
  }
  nodes_ = start;
  evaluate();
  return false;
}

bool ElasticSearch::take_step() {
  for (double shift = 0; shift <= largest_shift; shift = shift == 0 ? first_shift : 10 * shift)
    if (tangent_.factorise(nodes_, shift) && descend(tangent_.solve(free_force_))) return true;
  return false;
}

ElasticResult ElasticSearch::run() {
  result_.residual.push_back(largest());
  while (largest() > options_.tolerance * now_.scale && result_.iterations < options_.max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    if (!take_step()) break;
    ++result_.iterations;
    result_.residual.push_back(largest());
  }
  result_.nodes = to_points(nodes_);
  result_.tension = now_.tension;
  result_.out_of_balance = largest();
  const Coordinates vectors = branch_vectors(net_.net, nodes_);
  for (int b = 0; b < vectors.rows(); ++b)
    result_.n_slack += branch_force(net_, b, vectors.row(b).norm()).slack;
  const double limit = options_.tolerance * now_.scale;
  result_.converged = largest() <= limit;
  result_.reason =
      fmt::format("{}largest force out of balance {:.3g} N {} {:.3g} N",
                  result_.converged ? "" : fmt::format("stopped after {} iterations: ", result_.iterations),
                  largest(), result_.converged ? "<=" : ">", limit);
  return std::move(result_);
}

}  // namespace

ElasticResult find_elastic_equilibrium(const ElasticNet& net, const ElasticOptions& options) {
  check(net);
  if (!net.film.empty() || !net.net.guides.empty())
    throw ModelError(
        "Newton's method on elastic nets knows neither films nor guides: use dynamic relaxation");
  return ElasticSearch(net, options).run();
}

}  // namespace tautline::formfinding
