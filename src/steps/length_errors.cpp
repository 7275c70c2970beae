#include "steps/length_errors.hpp"

#include <algorithm>

#include <tautline/formfinding/tolerance.hpp>

namespace tautline::steps {

namespace {

/// All cables of the structure, as far as they have a stiffness of their own.
formfinding::ElasticNet all_cables(const model::Model& structure, const FormNet& form,
                                   std::vector<int>& cables) {
  formfinding::ElasticNet net;
  net.net.nodes = structure.nodes;
  net.net.fixed.assign(structure.nodes.size(), true);
  for (std::size_t i = 0; i < structure.cables.size(); ++i)
    if (structure.groups[structure.cables[i].group].kind == model::ElementKind::cable)
      cables.push_back(static_cast<int>(i));
  const auto n = static_cast<Eigen::Index>(cables.size());
  net.axial_stiffness.resize(n);
  net.unstressed_length.resize(n);
  for (Eigen::Index b = 0; b < n; ++b) {
    const auto& cable = structure.cables[cables[static_cast<std::size_t>(b)]];
    net.net.branches.push_back(cable.nodes);
    net.axial_stiffness[b] = structure.axial_stiffness(cable);
    net.unstressed_length[b] = structure.unstressed_length(cable);
    for (const int node : cable.nodes) net.net.fixed[node] = false;
  }
  const auto rotational = structure.rotational_nodes();
  for (std::size_t i = 0; i < structure.nodes.size(); ++i)
    if (rotational[i] || (form.local[i] >= 0 && form.net.fixed[form.local[i]])) net.net.fixed[i] = true;
  for (const auto& support : structure.supports)
    if (support.fixed[0] && support.fixed[1] && support.fixed[2])
      for (const int node : support.nodes) net.net.fixed[node] = true;
  return net;
}

std::vector<formfinding::Deviation1d> deviations(const model::Model& structure, const FormNet& form) {
  std::vector<formfinding::Deviation1d> list;
  for (std::size_t i = 0; i < form.nodes.size(); ++i) {
    if (form.net.fixed[i]) continue;
    Vec3 normal = Vec3::UnitZ();
    if (form.surface != nullptr) {
      const Vec3& at = structure.nodes[form.nodes[i]];
      const Vec3 height = form.surface->height_and_slope(at.x(), at.y());
      normal = Vec3(-height[1], -height[2], 1).normalized();
    }
    list.push_back({form.nodes[i], normal});
  }
  return list;
}

}  // namespace

Json length_errors_json(const Context& context, const LengthErrorOptions& options, const FormNet& form) {
  const auto& structure = context.structure;
  std::vector<int> cables;
  const auto net = all_cables(structure, form, cables);
  const auto n = static_cast<Eigen::Index>(cables.size());
  const auto found = formfinding::analyse_tolerance(net, VecX::Constant(n, options.sigma),
                                                    deviations(structure, form), options.sampling);
  Json entry{{"sigma", options.sigma}, {"rms_expected", found.rms_expected}};
  if (options.sampling.n_samples > 0) {
    entry["samples"] = options.sampling.n_samples;
    entry["rms_median"] = found.rms_quantile(0.5);
    entry["rms_95"] = found.rms_quantile(0.95);
  }
  Json& groups = entry["tension_sigma"] = Json::object();
  for (Eigen::Index b = 0; b < n; ++b) {
    const auto& name = structure.groups[structure.cables[cables[static_cast<std::size_t>(b)]].group].name;
    groups[name] = std::max(groups.value(name, 0.0), found.tension_sigma[b]);
  }
  return entry;
}

}  // namespace tautline::steps
