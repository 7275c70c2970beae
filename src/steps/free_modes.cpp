#include "steps/free_modes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <fmt/format.h>

#include <tautline/assembly/bodies.hpp>
#include <tautline/core/error.hpp>
#include <tautline/la/session.hpp>

namespace tautline::steps {

namespace {

la::Vector distributed(const assembly::System& system, const std::vector<double>& all) {
  const auto& layout = system.layout();
  la::Vector vector(layout);
  vector.write(std::span(all).subspan(static_cast<std::size_t>(3 * layout.first),
                                      static_cast<std::size_t>(3 * layout.local)));
  return vector;
}

/// One over the root of the stiffness that stands against each unknown, so that forces and moments, and
/// motions of soft and stiff parts, can be compared without a unit.
class Scaling {
 public:
  explicit Scaling(const la::SymmetricMatrix& stiffness) : root_(stiffness.absolute_row_sums()) {
    for (double& value : root_) value = std::sqrt(value);
  }
  /// Of this rank's part of a force: K^-1/2 f; of unknowns without stiffness nothing.
  VecX force(const la::Vector& f) const {
    VecX own(static_cast<Eigen::Index>(root_.size()));
    f.read(std::span(own.data(), root_.size()));
    for (Eigen::Index i = 0; i < own.size(); ++i) {
      const double root = root_[static_cast<std::size_t>(i)];
      own[i] = root > 0 ? own[i] / root : 0;
    }
    return own;
  }
  VecX motion(const la::Vector& x) const {
    VecX own(static_cast<Eigen::Index>(root_.size()));
    x.read(std::span(own.data(), root_.size()));
    for (Eigen::Index i = 0; i < own.size(); ++i) own[i] *= root_[static_cast<std::size_t>(i)];
    return own;
  }

 private:
  std::vector<double> root_;
};

MatX summed(MatX values) {
  std::vector<double> flat(values.data(), values.data() + values.size());
  la::sum_over_ranks(flat);
  return Eigen::Map<const MatX>(flat.data(), values.rows(), values.cols());
}

/// Forces out of balance in the state, which turn with a rigid rotation.
la::Vector out_of_balance(assembly::System& system) {
  la::Vector zero(system.layout()), force(system.layout());
  zero.set_zero();
  system.restart();
  system.set_lambda(1);
  system.residual(zero, force);
  return force;
}

/// Combinations of motions (columns of `motion`, scaled) whose forces (of `force`) are nothing but rounding,
/// or than what is out of balance by itself explains.
MatX without_force(const MatX& motion, const MatX& force, double imbalance) {
  constexpr double nothing = 1e-10;  // of the forces that the motion of each node alone would make
  constexpr double loaded = 1e-7;    // more than that is no imbalance, but loads that turn with nothing
  const MatX of_motion = summed(motion.transpose() * motion), of_force = summed(force.transpose() * force);
  const Eigen::SelfAdjointEigenSolver<MatX> metric(of_motion);
  const VecX& sizes = metric.eigenvalues();
  MatX orthonormal = metric.eigenvectors();
  for (Eigen::Index i = 0; i < sizes.size(); ++i) orthonormal.col(i) /= std::sqrt(std::max(sizes[i], 1e-300));
  const MatX resistance = orthonormal.transpose() * of_force * orthonormal;
  const Eigen::SelfAdjointEigenSolver<MatX> eigen((resistance + resistance.transpose()) / 2);
  const double imbalanced = imbalance / std::sqrt(std::max(sizes.maxCoeff(), 1e-300));
  const double limit = std::pow(nothing + std::min(imbalanced, loaded), 2);
  Eigen::Index count = 0;
  while (count < sizes.size() && eigen.eigenvalues()[count] <= limit) ++count;
  return orthonormal * eigen.eigenvectors().leftCols(count);
}

/// Combinations of the motions (columns) that no spring to the ground resists, however soft it is: beside a
/// stiff structure its forces would be taken for rounding.
MatX without_springs(const assembly::System& system, const std::vector<la::Vector>& motions) {
  constexpr double nothing = 1e-9;  // of what the largest of the motions does to the springs
  const auto& model = system.model();
  const auto n = static_cast<Eigen::Index>(motions.size());
  std::vector<assembly::System::NodalField> fields;
  for (const auto& motion : motions) fields.push_back(system.nodal(motion));
  std::vector<VecX> rows;
  for (const auto& spring : model.springs) {
    if (!spring.grounded()) continue;
    const auto& properties = model.groups[static_cast<std::size_t>(spring.group)].spring;
    const auto node = static_cast<std::size_t>(spring.nodes.front());
    for (int k = 0; k < 6; ++k) {
      if ((k < 3 ? properties.stiffness[k] : properties.rotational_stiffness[k - 3]) == 0) continue;
      VecX& row = rows.emplace_back(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto& field = fields[static_cast<std::size_t>(i)];
        row[i] = k < 3 ? field.displacement[node][k] : system.size() * field.rotation[node][k - 3];
      }
    }
  }
  if (rows.empty()) return MatX::Identity(n, n);
  MatX resisted(static_cast<Eigen::Index>(rows.size()), n);
  for (std::size_t i = 0; i < rows.size(); ++i) resisted.row(static_cast<Eigen::Index>(i)) = rows[i];
  const Eigen::JacobiSVD<MatX> svd(resisted, Eigen::ComputeFullV);
  const VecX& values = svd.singularValues();
  const auto rank = (values.array() > nothing * values[0]).count();
  return svd.matrixV().rightCols(n - rank);
}

}  // namespace

RigidModes rigid_modes(assembly::System& system, const la::SymmetricMatrix& stiffness,
                       const la::SymmetricMatrix& mass) {
  constexpr double none = 1e-12;  // of the mass that others move against the same stiffness
  std::vector<la::Vector> motions;
  for (const auto& motion : assembly::rigid_motions(system)) motions.push_back(distributed(system, motion));
  const auto n = static_cast<Eigen::Index>(motions.size());
  if (n == 0) return {};
  const Scaling scaling(stiffness);
  const la::Vector imbalance = out_of_balance(system);
  la::Vector product(system.layout());
  const Eigen::Index rows = motions.front().local_size();
  MatX motion(rows, n), force(rows, n), masses(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& one = motions[static_cast<std::size_t>(k)];
    motion.col(k) = scaling.motion(one);
    stiffness.multiply(one, product);
    force.col(k) = scaling.force(product);
    mass.multiply(one, product);
    for (Eigen::Index j = 0; j < n; ++j) masses(j, k) = motions[static_cast<std::size_t>(j)].dot(product);
  }
  const double left = std::sqrt(la::sum_over_ranks(scaling.force(imbalance).squaredNorm()));
  const MatX unsprung = without_springs(system, motions);
  if (unsprung.cols() == 0) return {};
  const MatX basis = unsprung * without_force(motion * unsprung, force * unsprung, 10 * left);
  if (basis.cols() == 0) return {};
  const MatX reduced = basis.transpose() * masses * basis;
  const Eigen::SelfAdjointEigenSolver<MatX> eigen((reduced + reduced.transpose()) / 2);
  RigidModes result;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    la::Vector mode(system.layout());
    mode.set_zero();
    const double moved = eigen.eigenvalues()[k];
    const bool has_mass = moved > none * eigen.eigenvalues().maxCoeff();
    const VecX weights = basis * eigen.eigenvectors().col(k) / (has_mass ? std::sqrt(moved) : 1);
    for (Eigen::Index j = 0; j < n; ++j) mode.add(weights[j], motions[static_cast<std::size_t>(j)]);
    (has_mass ? result.modes : result.massless).push_back(std::move(mode));
  }
  return result;
}

namespace {

/// Looks for a shift of about the size of the first elastic eigenvalue.
class ShiftSearch {
 public:
  ShiftSearch(assembly::System& system, const la::SymmetricMatrix& stiffness, const la::SymmetricMatrix& mass,
              const std::vector<la::Vector>& rigid)
      : system_(system), stiffness_(stiffness), mass_(mass), rigid_(rigid), x_(system.layout()) {
    std::vector<double> own(static_cast<std::size_t>(3 * system.layout().local));
    const auto first = static_cast<std::size_t>(3 * system.layout().first);
    for (std::size_t i = 0; i < own.size(); ++i)
      own[i] = system.held()[first + i] ? 0 : std::sin(12.9898 * static_cast<double>(first + i + 1));
    x_.write(own);
  }

  /// @throws ModelError if a motion meets neither stiffness nor mass
  double find() {
    constexpr int most = 12;
    constexpr double lowest = 1e-10, near = 30;  // of the first estimate; of the shift
    const double first = quotient();
    double shift = 1e-3 * first;
    for (int round = 0; round < most; ++round) {
      const double next = std::max(improved(shift), lowest * first);
      if (next > shift / near) return std::min(shift, next);
      shift = next;
    }
    return shift;
  }

 private:
  double quotient() {
    keep_rigid_out();
    la::Vector product(system_.layout());
    mass_.multiply(x_, product);
    return std::abs(system_.second_variation(x_)) / x_.dot(product);
  }

  void keep_rigid_out() {
    la::Vector product(system_.layout());
    mass_.multiply(x_, product);
    for (const auto& mode : rigid_) x_.add(-mode.dot(product), mode);
    mass_.multiply(x_, product);
    x_.scale(1 / std::sqrt(x_.dot(product)));
  }

  /// Rayleigh's quotient after some inverse iterations with a shift.
  double improved(double shift) {
    la::DirectSolver solver;
    const auto shifted = stiffness_.plus(shift, mass_);
    const bool first = std::exchange(is_first_, false);  // later pivots of rigid motions come near rounding
    if (!solver.factor(shifted) || (first && solver.inertia().null > 0))
      throw ModelError(
          "some part of the structure has neither stiffness nor mass against a motion, so that its "
          "vibrations "
          "are not defined: give it mass, or prestress, or support it");
    la::Vector right(system_.layout());
    double value = 0;
    for (int i = 0; i < 4; ++i) {
      mass_.multiply(x_, right);
      solver.solve(right, x_);
      value = quotient();
    }
    return value;
  }

  assembly::System& system_;
  const la::SymmetricMatrix& stiffness_;
  const la::SymmetricMatrix& mass_;
  const std::vector<la::Vector>& rigid_;
  la::Vector x_;
  bool is_first_ = true;
};

/// Whether a mode meets no resistance: strain energy at the level of the rounding of the stiffness, or, where
/// what moves has none at all, far below that of a mode at the shift.
bool is_mechanism(assembly::System& system, const Scaling& scaling, const la::Vector& mode, double shift) {
  constexpr double nothing = 1e-14, nothing_at_all = 1e-12;
  const double size = la::sum_over_ranks(scaling.motion(mode).squaredNorm());
  return std::abs(system.second_variation(mode)) <= std::max(nothing * size, nothing_at_all * shift);
}

/// A motion that meets neither stiffness nor mass is taken out of every mode: one unknown that it moves gets
/// a stiffness, which each mode can meet at rest.
la::SymmetricMatrix without_massless(const assembly::System& system, const la::SymmetricMatrix& stiffness,
                                     const std::vector<la::Vector>& massless) {
  la::SymmetricMatrix result = stiffness.shifted(0);
  const double scale = stiffness.norm_of_diagonal() / std::sqrt(static_cast<double>(system.n_dofs()));
  std::vector<std::size_t> taken;
  for (const auto& motion : massless) {
    std::vector<double> all, diagonal(static_cast<std::size_t>(system.n_dofs()), 0.0);
    motion.gather(all);
    std::size_t most = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (std::find(taken.begin(), taken.end(), i) == taken.end() &&
          std::abs(all[i]) > (1 + 1e-9) * std::abs(all[most]))
        most = i;
    taken.push_back(most);
    diagonal[most] = 1;
    result.add_diagonal(scale, distributed(system, diagonal));
  }
  return result;
}

void move_pair(la::EigenPairs& from, std::size_t i, la::EigenPairs& to) {
  to.values.push_back(from.values[i]);
  to.residuals.push_back(from.residuals[i]);
  to.vectors.push_back(std::move(from.vectors[i]));
}

}  // namespace

FreeModes solve_free(assembly::System& system, const la::SymmetricMatrix& stiffness_alone,
                     const la::SymmetricMatrix& mass, const RigidModes& known, int count) {
  constexpr int most_mechanisms = 100;
  const la::SymmetricMatrix stiffness = without_massless(system, stiffness_alone, known.massless);
  const auto& rigid = known.modes;
  const double shift = ShiftSearch(system, stiffness, mass, rigid).find();
  const Scaling scaling(stiffness_alone);
  for (int more = 0;;) {
    auto pairs = la::solve_vibration(stiffness, mass, count + more, -shift, rigid);
    FreeModes result;
    for (std::size_t i = 0; i < pairs.values.size(); ++i) {
      const bool free = is_mechanism(system, scaling, pairs.vectors[i], shift);
      if (!free && static_cast<int>(result.elastic.values.size()) == count) continue;
      move_pair(pairs, i, free ? result.mechanisms : result.elastic);
    }
    result.elastic.timings = pairs.timings;
    if (static_cast<int>(result.elastic.values.size()) == count) return result;
    more = static_cast<int>(result.mechanisms.values.size());
    if (more > most_mechanisms)
      throw ModelError(fmt::format(
          "the structure can move without resistance in more than {} ways beside those of a rigid body: "
          "prestress it or add members",
          most_mechanisms));
  }
}

}  // namespace tautline::steps
