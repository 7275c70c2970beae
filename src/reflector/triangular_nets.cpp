#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <reflector/triangular_nets.hpp>
#include <tautline/core/error.hpp>

namespace tautline::reflector {

void check_triangular_nets(const TriangularNetOptions& options) {
  if (options.rings < 1)
    throw ModelError(fmt::format("the net needs at least one ring, not {}", options.rings));
  if (!(options.gap >= 0))
    throw ModelError(
        fmt::format("the gap between front and rear net must not be negative, not {} m", options.gap));
}

TriangularNets::TriangularNets(const TriangularNetOptions& options)
    : surface_(make_paraboloid(options)), lattice_(options.rings), net_options_(options) {}

int TriangularNets::add_group(const std::string& name, model::ElementKind kind) {
  model::Group group;
  group.name = name;
  group.kind = kind;
  model_.groups.push_back(group);
  return static_cast<int>(model_.groups.size()) - 1;
}

void TriangularNets::add_net_nodes() {
  for (int k = 0; k <= lattice_.rings(); ++k) {
    const double radius = net_options_.aperture / 2 * k / lattice_.rings();
    for (int j = 0; j < std::max(1, 6 * k); ++j) {
      const double azimuth = 2 * std::numbers::pi * j / std::max(1, 6 * k);
      const double x = radius * std::cos(azimuth), y = radius * std::sin(azimuth);
      model_.nodes.emplace_back(x, y, surface_.height(x, y));
    }
  }
  double rim_height = -std::numeric_limits<double>::infinity();
  for (int j = 0; j < lattice_.n_rim(); ++j)
    rim_height = std::max(rim_height, model_.nodes[lattice_.rim(j)].z());
  if (!std::isnan(net_options_.rim_height)) rim_height = net_options_.rim_height;
  for (int j = 0; j < lattice_.n_rim(); ++j) model_.nodes[lattice_.rim(j)].z() = rim_height;

  for (int i = 0; i < lattice_.n_nodes(); ++i) {
    const Vec3 front = model_.nodes[i];
    model_.nodes.emplace_back(front.x(), front.y(), -front.z() - net_options_.gap);
  }
  check_apart();
}

void TriangularNets::check_apart() const {
  const auto distance = [&](int i) { return model_.nodes[i].z() - model_.nodes[rear(i)].z(); };
  int nearest = 0;
  for (int i = 1; i < lattice_.n_nodes(); ++i)
    if (distance(i) < distance(nearest)) nearest = i;
  if (distance(nearest) > 0) return;
  const Vec3& node = model_.nodes[nearest];
  const bool on_rim = nearest >= lattice_.n_free();
  throw ModelError(fmt::format(
      "front and rear net touch or cross: the {} at x = {:.4g} m, y = {:.4g} m would be {:.4g} m long; "
      "give a larger {} (rim height {:.4g} m, gap {:.4g} m)",
      on_rim ? "distance between the rims" : "tie", node.x(), node.y(), distance(nearest),
      on_rim ? "rim height or gap" : "gap", model_.nodes[lattice_.rim(0)].z(), net_options_.gap));
}

void TriangularNets::add_nets_and_ties() {
  const int front_net = add_group("front_net", model::ElementKind::cable);
  for (const auto& [i, j] : lattice_.sides()) model_.cables.push_back({{i, j}, front_net});
  const int rear_net = add_group("rear_net", model::ElementKind::cable);
  for (const auto& [i, j] : lattice_.sides()) model_.cables.push_back({{rear(i), rear(j)}, rear_net});
  const int ties = add_group("ties", model::ElementKind::cable);
  for (int i = 0; i < lattice_.n_free(); ++i) model_.cables.push_back({{i, rear(i)}, ties});
}

void TriangularNets::add_cloth() {
  const int cloth = add_group("cloth", model::ElementKind::membrane);
  for (const auto& facet : lattice_.facets()) model_.membranes.push_back({facet, cloth});
}

void TriangularNets::add_net_selections() {
  for (int i = 0; i < lattice_.n_nodes(); ++i) {
    const std::string kind = i < lattice_.n_free() ? "net_nodes" : "rim_nodes";
    model_.selections["front_" + kind].nodes.push_back(i);
    model_.selections["rear_" + kind].nodes.push_back(rear(i));
  }
}

void TriangularNets::hold_strut(const std::vector<std::vector<int>>& beams, double azimuth) {
  std::size_t held = 0;
  double largest_cosine = -2;
  for (std::size_t strut = 0; strut < beams.size(); ++strut) {
    const double place = static_cast<double>(strut) / static_cast<double>(beams.size());
    const double cosine = std::cos(2 * std::numbers::pi * (place - azimuth / 360));
    if (cosine <= largest_cosine) continue;
    largest_cosine = cosine;
    held = strut;
  }
  model_.selections["held_strut"].beams = beams[held];
}

}  // namespace tautline::reflector
