#pragma once
/// The rim reflector of Belov (2021) and its front net, for the tests of this folder.

#include <reflector/tables.hpp>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/reflector/perimeter_truss.hpp>

namespace tautline::reflector {

inline PerimeterTrussOptions rim_options(int rings = 10) {
  PerimeterTrussOptions options;
  options.aperture = 12;
  options.focal_length = 8;
  options.clearance = 1.125;
  options.rings = rings;
  options.rim_height = 0.98;
  options.struts = 30;
  options.gap = 0.02;
  return options;
}

/// The first group of cables, the front net, with the rim nodes fixed.
inline formfinding::Net front_net(const model::Model& model) {
  formfinding::Net net;
  const std::size_t n_nodes = model.nodes.size() / 2;
  net.nodes.assign(model.nodes.begin(), model.nodes.begin() + n_nodes);
  net.fixed.assign(n_nodes, false);
  for (const int node : model.selections.at("front_rim_nodes").nodes) net.fixed[node] = true;
  for (const auto& cable : model.cables)
    if (model.groups[cable.group].name == "front_net") net.branches.push_back(cable.nodes);
  return net;
}

}  // namespace tautline::reflector
