#include <formfinding/elastic_tangent.hpp>

namespace tautline::formfinding {

constexpr double guide_stiffness = 1e6;  // over that of the net at the node

ElasticTangent::ElasticTangent(const ElasticNet& net) : net_(net), free_index_(net.net.nodes.size(), -1) {
  for (std::size_t node = 0; node < net.net.nodes.size(); ++node) {
    if (net.net.fixed[node]) continue;
    free_index_[node] = n_free();
    free_nodes_.push_back(static_cast<int>(node));
  }
}

bool ElasticTangent::factorise(const Coordinates& nodes, double shift,
                               const std::function<void(const AddBlock&)>& add_film) {
  SparseFactor::Entries entries;
  const auto add = [&](int i, int j, const Mat3& block) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (3 * i + a >= 3 * j + b) entries.emplace_back(3 * i + a, 3 * j + b, block(a, b));
  };
  const Coordinates vectors = branch_vectors(net_.net, nodes);
  for (int b = 0; b < vectors.rows(); ++b) {
    const double length = vectors.row(b).norm();
    const BranchForce force = branch_force(net_, b, length);
    const Vec3 axis = vectors.row(b).transpose() / length;
    const double across = force.tension / length;
    const Mat3 block = (force.stiffness - across) * axis * axis.transpose() + across * Mat3::Identity();
    const int i = free_index_[net_.net.branches[b][0]], j = free_index_[net_.net.branches[b][1]];
    if (i >= 0) add(i, i, block);
    if (j >= 0) add(j, j, block);
    if (i >= 0 && j >= 0) add(std::max(i, j), std::min(i, j), -block);
  }
  if (add_film)
    add_film([&](int a, int b, const Mat3& block) {
      if (free_index_[a] >= 0 && free_index_[b] >= 0) add(free_index_[a], free_index_[b], block);
    });
  const VecX stiffness = nodal_stiffness(net_, nodes);
  for (const Guide& guide : net_.net.guides) {
    const Vec3 along = guide.direction.normalized();
    const Mat3 onto = along * along.transpose();
    const int i = free_index_[guide.node];
    add(i, i,
        guide_stiffness * stiffness[guide.node] *
            (guide.kind == Guide::Kind::plane ? onto : Mat3(Mat3::Identity() - onto)));
  }
  for (int i = 0; i < n_free(); ++i) add(i, i, shift * stiffness[free_nodes_[i]] * Mat3::Identity());
  return factor_.factorise(3 * n_free(), entries) < 0 && factor_.negative_pivots() == 0;
}

Coordinates ElasticTangent::solve(const Coordinates& force) const {
  const VecX moved = factor_.solve(VecX(Eigen::Map<const VecX>(force.data(), force.size())));
  return Eigen::Map<const Coordinates>(moved.data(), n_free(), 3);
}

}  // namespace tautline::formfinding
