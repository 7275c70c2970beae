// Whether nodes that loads move are where the loads say: told from the boundary and the state alone, so that
// it finds what was lost between them.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/assembly/system.hpp>
#include <tautline/model/names.hpp>

namespace tautline::assembly {

void System::note_prescribed(const Boundary& boundary) {
  prescribed_.clear();
  for (const auto& load : boundary.loads) {
    if (!load.displacement) continue;
    auto nodes = model_.nodes_of(load.on);
    nodes.insert(nodes.end(), load.nodes.begin(), load.nodes.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const int node : nodes) {
      auto& motion = prescribed_[node];
      motion.from = state_.displacement[node];
      motion.to += *load.displacement;
      motion.load = load.name;
    }
  }
}

void System::check_prescribed() const {
  constexpr double tolerance = 1e-9;  // of the structure and the motion: far above the rounding of sums
  for (const auto& [node, motion] : prescribed_) {
    const int block = map_.displacement_block[node];
    if (block < 0) continue;  // a follower is moved by none
    const Vec3 miss = state_.displacement[node] - ((1 - lambda_) * motion.from + lambda_ * motion.to);
    for (int c = 0; c < 3; ++c) {
      if (!held()[static_cast<std::size_t>(3 * block + c)]) continue;
      const double off = std::abs(kinematics_.frame(block).col(c).dot(miss));
      if (off > tolerance * (size_ + motion.from.norm() + motion.to.norm()))
        throw std::logic_error(fmt::format(
            "load \"{}\" moves {}, which is {:.3g} m from where the load puts it at lambda = {:.6g}",
            motion.load, model::node_at(model_, node), off, lambda_));
    }
  }
}

}  // namespace tautline::assembly
