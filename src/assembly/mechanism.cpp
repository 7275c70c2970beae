#include <tautline/assembly/mechanism.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <tautline/core/text.hpp>

namespace tautline::assembly {

namespace {

constexpr int rounds = 8;       // of inverse iteration
constexpr double soft = 1e-11;  // stiffness below this part of the largest counts as none

/// The softest motion of `tangent`, by inverse iteration on K + sigma I, and its stiffness.
std::pair<la::Vector, double> softest_motion(const la::SymmetricMatrix& tangent,
                                             const la::BlockLayout& layout) {
  const double sigma = 0.01 * soft * tangent.norm_of_diagonal();
  const auto shifted = tangent.shifted(sigma);
  la::DirectSolver solver;
  la::Vector x(layout), y(layout);
  std::vector<double> start(static_cast<std::size_t>(3 * layout.local));
  for (std::size_t i = 0; i < start.size(); ++i)
    start[i] = 1 + 0.5 * std::sin(1.7 * static_cast<double>(i + 3 * layout.first));
  x.write(start);
  if (!solver.factor(shifted)) return {std::move(x), 0};
  for (int i = 0; i < rounds; ++i) {
    solver.solve(x, y);
    const double length = y.norm();
    y.read(start);
    for (double& value : start) value /= length;
    x.write(start);
  }
  tangent.multiply(x, y);
  return {std::move(x), std::abs(x.dot(y))};
}

std::string direction_name(const Vec3& direction) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(direction[c]) > 0.99) return std::string(1, "xyz"[c]);
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", direction.x(), direction.y(), direction.z());
}

/// What hangs on a node, for the likely cause.
struct Neighbourhood {
  bool beams = false, shells = false, membranes = false, taut = false, prestressed = false;
};

Neighbourhood around(const model::Model& model, int node) {
  const auto touches = [node](const auto& element) {
    return std::find(element.nodes.begin(), element.nodes.end(), node) != element.nodes.end();
  };
  Neighbourhood n;
  for (const auto& beam : model.beams) n.beams = n.beams || touches(beam);
  for (const auto& shell : model.shells) n.shells = n.shells || touches(shell);
  for (const auto& cable : model.cables) n.taut = n.taut || (touches(cable) && cable.initial_strain > 0);
  for (const auto& membrane : model.membranes)
    if (touches(membrane)) {
      n.membranes = true;
      n.prestressed = n.prestressed || membrane.prestress.head<2>().minCoeff() > 0;
    }
  return n;
}

std::string likely_cause(const model::Model& model, int node, bool rotation) {
  for (const auto& link : model.links)
    if (rotation && link.follower == node)
      return "a hinge or release leaves this rotation free and nothing else holds it: release less, or hold "
             "it at "
             "the other end";
  const Neighbourhood n = around(model, node);
  if (n.beams || n.shells)
    return "the supports leave the frame free to move: hold it in more directions, or at more nodes";
  if (n.membranes && !n.prestressed && !n.taut)
    return "a membrane without prestress does not resist motion out of its plane: give its group a "
           "`prestress`";
  if (!n.membranes && !n.taut)
    return "cables without tension resist nothing across their line: give their group a `tension`, or "
           "support the node";
  return "neither the supports nor the prestress resist this motion: support the node or add a cable";
}

}  // namespace

std::optional<Mechanism> find_mechanism(System& system, analysis::Workspace& workspace) {
  system.tangent(workspace.tangent);
  const auto [motion, stiffness] = softest_motion(workspace.tangent, system.layout());
  if (stiffness > soft * workspace.tangent.norm_of_diagonal()) return std::nullopt;
  const auto& model = system.model();
  const auto field = system.nodal(motion);
  const auto amplitude = [&](int node) {
    return std::max(field.displacement[node].norm(), field.rotation[node].norm());
  };
  std::vector<int> order(model.nodes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto most = std::min<std::size_t>(5, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                    [&](int a, int b) { return amplitude(a) > amplitude(b); });
  Mechanism mechanism;
  for (std::size_t i = 0; i < most; ++i)
    if (amplitude(order[i]) > 0.5 * amplitude(order[0])) mechanism.nodes.push_back(order[i]);
  const int first = order[0];
  mechanism.rotation = field.rotation[first].norm() > field.displacement[first].norm();
  mechanism.direction = (mechanism.rotation ? field.rotation[first] : field.displacement[first]).normalized();
  std::vector<std::string> names;
  for (const int node : mechanism.nodes) {
    const Vec3& at = model.nodes[node];
    names.push_back(fmt::format("{} at ({:.4g}, {:.4g}, {:.4g})", node + 1, at.x(), at.y(), at.z()));
  }
  mechanism.text = fmt::format(
      "the structure can move without resistance: node{} {} {} {}; {}", names.size() == 1 ? "" : "s",
      join(names, ", "), mechanism.rotation ? "turning about" : "moving along",
      direction_name(mechanism.direction), likely_cause(model, first, mechanism.rotation));
  return mechanism;
}

}  // namespace tautline::assembly
