#include <tautline/assembly/bodies.hpp>

#include <cmath>
#include <numeric>

#include <Eigen/QR>
#include <Eigen/SVD>

#include <tautline/assembly/system.hpp>

namespace tautline::assembly {

namespace {

/// Sets of nodes that grow together.
class Union {
 public:
  explicit Union(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& parent = parent_[static_cast<std::size_t>(i)];
      parent = parent_[static_cast<std::size_t>(parent)];
      i = parent;
    }
    return i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// What a body's motions do at its nodes that its unknowns cannot follow: rows by the six motions, gathered
/// by an orthogonal triangle so that small bodies and large ones keep their digits.
class Mismatch {
 public:
  void add(const Mat<3, 6>& rows) {
    Eigen::Matrix<double, 9, 6> stack;
    stack << triangle_, rows;
    const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 6>> qr(stack);
    triangle_ = qr.matrixQR().topRows<6>().triangularView<Eigen::Upper>();
  }
  /// Combinations of the motions that do not miss, as columns.
  MatX null_space() const {
    constexpr double nothing = 1e-9;  // of the largest miss, or of a unit motion
    const Eigen::JacobiSVD<Mat<6>> svd(triangle_, Eigen::ComputeFullV);
    const double largest = std::max(1.0, svd.singularValues()[0]);
    int rank = 0;
    while (rank < 6 && svd.singularValues()[rank] > nothing * largest) ++rank;
    return svd.matrixV().rightCols(6 - rank);
  }

 private:
  Mat<6> triangle_ = Mat<6>::Zero();
};

struct Place {
  Vec3 centre = Vec3::Zero();
  double size = 0;
};

Place place_of(const Points& positions, const std::vector<int>& nodes) {
  Place place;
  for (const int node : nodes) place.centre += positions[node] / static_cast<double>(nodes.size());
  for (const int node : nodes) place.size = std::max(place.size, (positions[node] - place.centre).norm());
  if (place.size == 0) place.size = 1;
  return place;
}

/// Rigid motions of one body, rotations measured by what they move at its rim.
void add_motions(const System& system, const Points& positions, const std::vector<int>& nodes,
                 std::vector<std::vector<double>>& result) {
  const Place place = place_of(positions, nodes);
  auto motions = unit_motions(place.centre);
  for (auto& motion : motions) motion.rotation /= place.size;
  std::vector<std::vector<double>> columns;
  std::vector<System::NodalField> fields;
  for (const auto& motion : motions) {
    auto column = unknowns_of(system, nodes, motion);
    for (std::size_t i = 0; i < column.size(); ++i)
      if (system.held()[i]) column[i] = 0;
    fields.push_back(system.nodal(column));
    columns.push_back(std::move(column));
  }
  Mismatch mismatch;
  for (const int node : nodes) {
    Mat<3, 6> displacement, rotation;
    for (int k = 0; k < 6; ++k) {
      const auto& motion = motions[static_cast<std::size_t>(k)];
      const auto& field = fields[static_cast<std::size_t>(k)];
      displacement.col(k) = field.displacement[node] - motion.at(positions[node]);
      rotation.col(k) = place.size * (field.rotation[node] - motion.rotation);
    }
    mismatch.add(displacement);
    if (system.dof_map().rotational[static_cast<std::size_t>(node)]) mismatch.add(rotation);
  }
  const MatX basis = mismatch.null_space();
  for (Eigen::Index j = 0; j < basis.cols(); ++j) {
    std::vector<double> combined(columns.front().size(), 0.0);
    double largest = 0;
    for (std::size_t i = 0; i < combined.size(); ++i) {
      for (int k = 0; k < 6; ++k) combined[i] += basis(k, j) * columns[static_cast<std::size_t>(k)][i];
      largest = std::max(largest, std::abs(combined[i]));
    }
    if (largest > 0) result.push_back(std::move(combined));
  }
}

}  // namespace

std::vector<std::vector<int>> bodies_of(const model::Model& model) {
  Union sets(model.nodes.size());
  model::for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements)
      for (const int node : element.nodes) sets.join(element.nodes[0], node);
  });
  for (const auto& link : model.links) sets.join(link.leader, link.follower);
  for (const auto& pair : model.cyclic_pairs) sets.join(pair.leader, pair.follower);
  for (const auto& constraint : model.constraints)
    for (const auto& term : constraint.terms) sets.join(constraint.terms.front().node, term.node);
  std::vector<int> place(model.nodes.size(), -1);
  std::vector<std::vector<int>> bodies;
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node) {
    int& body = place[static_cast<std::size_t>(sets.root(node))];
    if (body < 0) {
      body = static_cast<int>(bodies.size());
      bodies.emplace_back();
    }
    bodies[static_cast<std::size_t>(body)].push_back(node);
  }
  return bodies;
}

std::vector<RigidMotion> unit_motions(const Vec3& centre) {
  std::vector<RigidMotion> motions(6);
  for (int k = 0; k < 6; ++k) {
    auto& motion = motions[static_cast<std::size_t>(k)];
    motion.centre = centre;
    (k < 3 ? motion.translation : motion.rotation) = Vec3::Unit(k % 3);
  }
  return motions;
}

std::vector<double> unknowns_of(const System& system, const std::vector<int>& nodes,
                                const RigidMotion& motion) {
  const auto& map = system.dof_map();
  const auto& kinematics = system.kinematics();
  std::vector<double> values(static_cast<std::size_t>(system.n_dofs()), 0.0);
  const auto set = [&](int block, const Vec3& value) {
    if (block >= 0) Eigen::Map<Vec3>(values.data() + 3 * block) = kinematics.unknown_of(block, value);
  };
  for (const int node : nodes) {
    const auto at = static_cast<std::size_t>(node);
    set(map.displacement_block[at], motion.at(system.model().nodes[at] + system.state().displacement[at]));
    const int link = kinematics.link_of(node);
    const bool hinge = link >= 0 && !system.model().links[static_cast<std::size_t>(link)].hinge.empty();
    if (!hinge) set(map.rotation_block[at], motion.rotation);
  }
  return values;
}

std::vector<std::vector<double>> rigid_motions(const System& system) {
  const auto positions = model::positions(system.model(), system.state());
  std::vector<std::vector<double>> result;
  for (const auto& nodes : bodies_of(system.model())) add_motions(system, positions, nodes, result);
  return result;
}

}  // namespace tautline::assembly
