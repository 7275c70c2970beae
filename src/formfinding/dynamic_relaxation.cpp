#include <tautline/formfinding/dynamic_relaxation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/film_balance.hpp>
#include <formfinding/film_mesh.hpp>
#include <formfinding/net_forces.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/formfinding/node_error.hpp>

namespace tautline::formfinding {

namespace {

/// The fictitious motion of the free nodes; one time step is the unit of time.
class Motion {
 public:
  Motion(const ElasticNet& net, const DynamicRelaxationOptions& options)
      : net_(net), options_(options), film_(net), system_(net.net), nodes_(to_coordinates(net.net.nodes)) {
    for (const Guide& guide : net.net.guides) put_on(guide);
    set_masses();
    evaluate();
  }

  RelaxationResult run();

 private:
  void put_on(const Guide& guide);
  /// M = K/2 (1.24) at the present shape.
  void set_masses();
  void evaluate();
  void start_from_rest();
  /// One step of (1.20)-(1.21); @param[in] damping  C/M
  void step(double damping);
  double kinetic_energy() const { return 0.5 * mass_.dot(velocity_.rowwise().squaredNorm()); }
  double largest_force() const { return force_.rows() > 0 ? force_.rowwise().norm().maxCoeff() : 0.0; }
  bool at_rest() const { return largest_force() <= options_.tolerance * scale_; }
  bool goes_on() const { return !at_rest() && !collapsed_ && result_.iterations < options_.max_iterations; }
  /// Back to the time of the peak (1.28)-(1.29), from the last three energies.
  void return_to_peak(double e1, double e2, double e3);
  void run_kinetic();
  void run_viscous();
  /// Circular frequency from the time of the first peak of a run without damping: a quarter of a period.
  double pilot_frequency();

  const ElasticNet& net_;
  const DynamicRelaxationOptions& options_;
  FilmNet film_;
  NetSystem system_;
  Coordinates nodes_;
  VecX mass_;             ///< of the free nodes [N/m x time step^2]
  Coordinates force_;     ///< out of balance, free nodes [N]
  Coordinates velocity_;  ///< half a step before [m / time step]
  Coordinates previous_velocity_, previous_force_;
  VecX tension_;
  double scale_ = 0;
  bool collapsed_ = false;  ///< nodes of a film have run together
  RelaxationResult result_;
};

void Motion::put_on(const Guide& guide) {
  const Vec3 along = guide.direction.normalized(),
             arm = Vec3(nodes_.row(guide.node).transpose()) - guide.point;
  const Vec3 kept =
      guide.kind == Guide::Kind::line ? Vec3(along * along.dot(arm)) : Vec3(arm - along * along.dot(arm));
  nodes_.row(guide.node) = guide.point + kept;
}

void Motion::set_masses() {
  VecX stiffness = nodal_stiffness(net_, nodes_);
  if (!net_.film.empty()) {  // the drawn force densities pull along the film
    VecX drawn = VecX::Zero(stiffness.size());
    for (Eigen::Index b = 0; b < film_.drawn.size(); ++b)
      for (const int node : film_.net.branches[static_cast<std::size_t>(b)])
        drawn[node] += std::abs(film_.drawn[b]);
    stiffness = stiffness.cwiseMax(drawn);
  }
  mass_ = 0.5 * options_.mass_factor * stiffness(system_.free_nodes());
  for (int i = 0; i < system_.n_free(); ++i)
    if (mass_[i] <= 0)
      throw NodeError("neither a cable nor a film is attached to ", {system_.free_nodes()[i]}, "");
}

void Motion::evaluate() {
  NetForces forces = net_forces(net_, nodes_);
  Coordinates force = forces.force(system_.free_nodes(), Eigen::all);
  if (!net_.film.empty()) FilmMesh(film_, system_.free_nodes(), nodes_).take_drawn_forces(nodes_, force);
  force_ = system_.unbalanced(std::move(force));
  collapsed_ = collapsed_ || !force_.allFinite();
  tension_ = std::move(forces.tension);
  scale_ = std::max(scale_, forces.scale);
}

void Motion::start_from_rest() {
  velocity_ = Coordinates::Zero(system_.n_free(), 3);
  // Half a step from rest, so that the velocity is that of the middle of the first step.
  velocity_ -= 0.5 * mass_.cwiseInverse().asDiagonal() * force_;
}

void Motion::step(double damping) {
  previous_velocity_ = velocity_;
  previous_force_ = force_;
  velocity_ =
      ((1 - damping / 2) * velocity_ + mass_.cwiseInverse().asDiagonal() * force_) / (1 + damping / 2);
  for (int i = 0; i < system_.n_free(); ++i) nodes_.row(system_.free_nodes()[i]) += velocity_.row(i);
  evaluate();
}

void Motion::return_to_peak(double e1, double e2, double e3) {
  const double curvature = e3 - 2 * e2 + e1;
  const double beta = curvature < 0 ? std::clamp((e3 - e2) / curvature, 0.0, 1.0) : 0.5;
  // x(n+1) - (1 + beta) v(n-1/2) - R(n)/M, and R(n)/M = v(n+1/2) - v(n-1/2).
  for (int i = 0; i < system_.n_free(); ++i)
    nodes_.row(system_.free_nodes()[i]) -= velocity_.row(i) + beta * previous_velocity_.row(i);
  evaluate();
}

void Motion::run_kinetic() {
  double e1 = 0, e2 = 0;
  start_from_rest();
  while (goes_on()) {
    if (interrupt_requested()) throw Interrupted();
    step(0);
    ++result_.iterations;
    const double e3 = kinetic_energy();
    if (e3 >= e2) {
      e1 = e2;
      e2 = e3;
      continue;
    }
    ++result_.n_peaks;
    return_to_peak(e1, e2, e3);
    set_masses();
    start_from_rest();
    e1 = e2 = 0;
  }
}

double Motion::pilot_frequency() {
  const Coordinates start = nodes_;
  start_from_rest();
  double before = 0;
  for (; result_.pilot_iterations < options_.max_iterations && !collapsed_; ++result_.pilot_iterations) {
    step(0);
    const double now = kinetic_energy();
    if (now < before) break;
    before = now;
  }
  nodes_ = start;
  evaluate();
  return M_PI / (2 * std::max(1, result_.pilot_iterations));
}

void Motion::run_viscous() {
  double frequency = pilot_frequency();
  start_from_rest();
  while (goes_on()) {
    if (interrupt_requested()) throw Interrupted();
    step(2 * options_.damping_ratio * frequency);  // C/M = 4 pi f (1.25)
    ++result_.iterations;
    // The pilot run meets several frequencies at once. What is left of the motion later is its slowest part;
    // its frequency is Rayleigh's quotient with the change of the force over the last step.
    const double work = velocity_.cwiseProduct(previous_force_ - force_).sum(), energy = 2 * kinetic_energy();
    if (work > 0 && energy > 0) frequency = std::min(std::sqrt(work / energy), 1.9);
    if (result_.iterations % 100 == 0) set_masses();
  }
  result_.period = 2 * M_PI / frequency;
}

RelaxationResult Motion::run() {
  if (options_.damping == Damping::kinetic)
    run_kinetic();
  else
    run_viscous();
  result_.converged = at_rest();
  result_.nodes = to_points(nodes_);
  result_.tension = tension_;
  result_.out_of_balance = largest_force();
  if (collapsed_) {
    result_.converged = false;
    result_.reason = fmt::format(
        "nodes of the film ran together after {} steps: more tension in edge cables, less stress in the "
        "film, or a start nearer to the shape may help",
        result_.iterations);
    return std::move(result_);
  }
  result_.reason =
      fmt::format("{}largest force out of balance {:.3g} N {} {:.3g} N",
                  result_.converged ? "" : fmt::format("stopped after {} steps: ", result_.iterations),
                  largest_force(), result_.converged ? "<=" : ">", options_.tolerance * scale_);
  return std::move(result_);
}

}  // namespace

RelaxationResult relax(const ElasticNet& net, const DynamicRelaxationOptions& options) {
  check(net);
  if (!net.film.empty()) check_areas(net.net, net.film);
  RelaxationResult result = Motion(net, options).run();
  if (net.film.empty()) return result;
  if (!result.converged) {
    result.reason += held_points(net.net, net.film);
    result.stress = target_stresses(net.film, to_coordinates(result.nodes));
    return result;
  }
  const SettledFilm settled = settle_film(net, result.nodes, options.tolerance);
  result.nodes = settled.nodes;
  result.stress = settled.stress;
  result.tension = settled.tension;
  result.out_of_balance = settled.out_of_balance;
  result.converged = settled.fault.empty();
  if (!result.converged) result.reason = settled.fault;
  return result;
}

}  // namespace tautline::formfinding
