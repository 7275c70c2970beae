#include <tautline/assembly/mechanism.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include <tautline/model/names.hpp>

namespace tautline::assembly {

namespace {

/// @brief The softest motion of a system and its stiffness, by inverse iteration about a small shift.
///
/// Stiffness is x^T K x over x^T D x, where D holds for each node the largest sum of |K| over a row of its
/// block: a number that changes with no unit and no axes. It is summed element by element, so that it keeps
/// its digits far below the rounding of K. Theory: docs/theory/newton.md#mechanisms
class SoftestMotion {
 public:
  static constexpr double null = 1e-17;  ///< stiffness below which counts as none

  SoftestMotion(System& system, const la::SymmetricMatrix& tangent)
      : system_(system), weight_(system.layout()), motion_(system.layout()), next_(system.layout()) {
    auto sums = tangent.absolute_row_sums_of_blocks();
    weight_.write(sums);
    const double size = weight_.norm();
    for (double& sum : sums)
      if (sum < 1e-200 * size) sum = size;  // what nothing resists at all
    weight_.write(sums);
    begin();
    auto shifted = tangent.shifted(0);
    shifted.add_diagonal(shift, weight_);
    if (!solver_.factor(shifted)) return;
    for (int i = 0; i < most_rounds; ++i) {
      const double last = stiffness_;
      advance();
      if (stiffness_ <= null || std::isinf(stiffness_) ||
          (i > 3 && std::abs(stiffness_ - last) <= 1e-3 * stiffness_))
        return;
    }
  }

  const la::Vector& motion() const { return motion_; }
  bool is_resisted() const { return stiffness_ > null; }

 private:
  static constexpr double shift = 1e-12;  // above the pivots that MUMPS takes for null
  static constexpr int most_rounds = 40;

  void begin() {
    const auto& layout = system_.layout();
    std::vector<double> start(static_cast<std::size_t>(3 * layout.local));
    for (std::size_t i = 0; i < start.size(); ++i) {
      const auto unknown = i + static_cast<std::size_t>(3 * layout.first);
      start[i] = system_.held()[unknown] ? 0 : 1 + 0.5 * std::sin(1.7 * static_cast<double>(unknown));
    }
    motion_.write(start);
  }

  void advance() {
    motion_.multiply_entries(weight_);
    solver_.solve(motion_, next_);
    motion_.copy(next_);
    next_.multiply_entries(weight_);
    const double size = std::sqrt(motion_.dot(next_));
    if (!(size > 0) || !std::isfinite(size)) {  // nothing is free to move
      stiffness_ = std::numeric_limits<double>::infinity();
      return;
    }
    motion_.scale(1 / size);
    stiffness_ = std::abs(system_.second_variation(motion_));
  }

  System& system_;
  la::DirectSolver solver_;
  la::Vector weight_, motion_, next_;
  double stiffness_ = 0;
};

/// The model with a taut cable beside every member and side of a facet: what it can do without resistance
/// changes no distance between nodes that an element joins.
model::Model tightened(model::Model model) {
  constexpr double strain = 1;
  double stiffness = 0;
  for (const auto& cable : model.cables) stiffness = std::max(stiffness, model.axial_stiffness(cable));
  for (const auto& group : model.groups)
    stiffness = std::max({stiffness, group.beam.axial_stiffness, group.membrane.tension_stiffness,
                          group.shell.young_modulus * group.shell.thickness});
  model.initial = {};
  const int group = static_cast<int>(model.groups.size());
  auto& cords = model.groups.emplace_back();
  cords.name = "cords";
  cords.kind = model::ElementKind::cable;
  cords.cable.axial_stiffness = stiffness > 0 ? stiffness : 1;
  std::vector<model::Cable> added;
  const auto join_ends = [&](const auto& nodes) {
    for (int k = 0, n = static_cast<int>(nodes.size()); k < (n > 2 ? n : 1); ++k)
      added.push_back({{nodes[k], nodes[(k + 1) % n]}, group, strain});
  };
  for (const auto& cable : model.cables) join_ends(cable.nodes);
  for (const auto& beam : model.beams) join_ends(beam.nodes);
  for (const auto& membrane : model.membranes) join_ends(membrane.nodes);
  for (const auto& shell : model.shells) join_ends(shell.nodes);
  model.cables.insert(model.cables.end(), added.begin(), added.end());
  return model;
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
  const SoftestMotion softest(system, workspace.tangent);
  if (softest.is_resisted()) return std::nullopt;
  const auto& model = system.model();
  const auto field = system.nodal(softest.motion());
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
  for (const int node : mechanism.nodes) names.push_back(model::node_in_group(model, node));
  mechanism.motion =
      fmt::format("the structure can move without resistance: {} {} {}", join(names, ", "),
                  mechanism.rotation ? "turning about" : "moving along", direction_name(mechanism.direction));
  mechanism.text = mechanism.motion + "; " + likely_cause(model, first, mechanism.rotation);
  return mechanism;
}

std::optional<Mechanism> find_loose_part(const model::Model& model, const Boundary& boundary) {
  System system(tightened(model));
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  system.begin_stage({boundary.supports, {}});
  return find_mechanism(system, workspace);
}

}  // namespace tautline::assembly
