#include "steps/form_net.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

#include "steps/reflector_form.hpp"

namespace tautline::steps {

namespace {

std::vector<std::string> groups_of_kind(const model::Model& structure, model::ElementKind kind) {
  std::vector<std::string> names;
  for (const auto& group : structure.groups)
    if (group.kind == kind) names.push_back(group.name);
  return names;
}

std::vector<std::string> net_groups(const Context& context, const FormFindingOptions& options) {
  if (!options.net.empty()) return options.net;
  if (context.surface) return front_net_groups(context.structure);
  return groups_of_kind(context.structure, model::ElementKind::cable);
}

std::vector<std::string> cloth_groups(const Context& context, const FormFindingOptions& options) {
  if (options.cloth) return *options.cloth;
  if (options.method != FormMethod::film && options.method != FormMethod::dynamic_relaxation) return {};
  return groups_of_kind(context.structure, model::ElementKind::membrane);
}

std::string place(const Vec3& at) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
}

void add_branches(const model::Model& structure, FormNet& form) {
  for (const auto& name : form.groups) {
    const auto cables = structure.select(name).cables;
    form.cables.insert(form.cables.end(), cables.begin(), cables.end());
  }
  auto all = form.groups;
  all.insert(all.end(), form.cloth.begin(), form.cloth.end());
  form.nodes = structure.nodes_of(all);
  form.local.assign(structure.nodes.size(), -1);
  for (std::size_t i = 0; i < form.nodes.size(); ++i) {
    form.local[form.nodes[i]] = static_cast<int>(i);
    form.net.nodes.push_back(structure.nodes[form.nodes[i]]);
  }
  for (const int cable : form.cables) {
    const auto& nodes = structure.cables[cable].nodes;
    form.net.branches.push_back({form.local[nodes[0]], form.local[nodes[1]]});
  }
}

/// Films have one stress in all directions, N11 = N22.
void add_cloth(const model::Model& structure, FormNet& form) {
  std::vector<double> stress;
  for (const auto& name : form.cloth)
    for (const int i : structure.select(name).membranes) {
      const auto& membrane = structure.membranes[i];
      const Vec3& n = membrane.prestress;
      if (!(n[0] > 0) || std::abs(n[0] - n[1]) > 1e-9 * n[0] || std::abs(n[2]) > 1e-9 * n[0])
        throw ModelError(fmt::format(
            "form-finding: the cloth \"{}\" needs one prestress > 0 in all directions, not {:.4g} and {:.4g} "
            "N/m: give its group `prestress` as one number",
            name, n[0], n[1]));
      for (const auto& triangle : membrane.nodes.triangles()) {
        form.triangles.push_back({form.local[triangle[0]], form.local[triangle[1]], form.local[triangle[2]]});
        form.membranes.push_back(i);
        stress.push_back(n[0]);
      }
    }
  form.surface_stress = Eigen::Map<const VecX>(stress.data(), static_cast<Eigen::Index>(stress.size()));
}

/// A support that holds one or two directions is a plane or line on which its nodes slide.
void add_support(const model::Support& support, FormNet& form) {
  const int held = static_cast<int>(std::count(support.fixed.begin(), support.fixed.begin() + 3, true));
  for (const int node : support.nodes) {
    const int i = form.local[node];
    if (i < 0 || held == 0 || form.net.fixed[i]) continue;
    if (held == 3) {
      form.net.fixed[i] = true;
      continue;
    }
    const auto odd =
        std::find(support.fixed.begin(), support.fixed.begin() + 3, held == 1) - support.fixed.begin();
    form.net.guides.push_back({i, held == 1 ? formfinding::GuideKind::plane : formfinding::GuideKind::line,
                               form.net.nodes[i], support.axes.col(odd)});
  }
}

/// Nodes that stay: those supported, named by `fixed`, or attached to beams.
void hold_nodes(const model::Model& structure, const FormFindingOptions& options, FormNet& form) {
  const auto rotational = structure.rotational_nodes();
  form.net.fixed.assign(form.nodes.size(), false);
  for (std::size_t i = 0; i < form.nodes.size(); ++i) form.net.fixed[i] = rotational[form.nodes[i]];
  for (const int node : structure.nodes_of(options.fixed))
    if (form.local[node] >= 0) form.net.fixed[form.local[node]] = true;
  for (const auto& support : structure.supports) add_support(support, form);
  std::vector<bool> from_support(form.nodes.size(), false);  // a guide of the step itself comes first
  for (const auto& guide : form.net.guides) from_support[guide.node] = true;
  for (const auto& guide : options.guides)
    for (const int i : form.nodes_of(structure, guide.on)) {
      if (form.net.fixed[i])
        throw ModelError(
            fmt::format("form-finding: the guided node at {} is fixed", place(form.net.nodes[i])));
      std::erase_if(form.net.guides,
                    [&](const auto& other) { return from_support[other.node] && other.node == i; });
      from_support[i] = false;
      form.net.guides.push_back(
          {i, guide.kind, guide.point.value_or(form.net.nodes[i]), guide.direction.normalized()});
    }
  auto& guides = form.net.guides;
  std::erase_if(guides, [&](const auto& guide) { return form.net.fixed[guide.node]; });
  std::sort(guides.begin(), guides.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  const auto twice = std::adjacent_find(guides.begin(), guides.end(),
                                        [](const auto& a, const auto& b) { return a.node == b.node; });
  if (twice != guides.end())
    throw ModelError(fmt::format("form-finding: two guides or supports lead the node at {}; one line does",
                                 place(form.net.nodes[twice->node])));
}

/// Form-finding takes forces on nodes of the net. @throws ModelError for anything else in the load
void check_load(const Context& context, const model::Load& load, const FormNet& form) {
  const bool other = !load.moment.isZero(0) || load.moves() || !load.line_force.isZero(0) ||
                     !load.line_moment.isZero(0) || !load.surface_force.isZero(0) || load.pressure != 0 ||
                     load.heats() || !load.acceleration.isZero(0);
  if (other)
    throw ModelError(fmt::format(
        "{}: step \"{}\" names it, but form-finding takes no loads but forces on nodes (`force`); leave the others "
        "to the equilibrium that follows",
        load.title(), context.step_name));
  for (const int node : load.nodes)
    if (form.local[node] < 0)
      throw ModelError(fmt::format("{}: step \"{}\" names it, but the node at {} is no part of the net",
                                   load.title(), context.step_name, place(context.structure.nodes[node])));
}

void add_loads(const Context& context, const FormFindingOptions& options, FormNet& form) {
  if (options.loads.empty()) return;
  form.net.load.assign(form.nodes.size(), Vec3::Zero());
  for (const auto& load : context.structure.loads) {
    if (std::find(options.loads.begin(), options.loads.end(), load.name) == options.loads.end()) continue;
    check_load(context, load, form);
    for (const int node : load.nodes) form.net.load[form.local[node]] += load.force;
  }
}

std::unique_ptr<formfinding::Surface> make_surface(const FormSurfaceOptions& options) {
  using namespace formfinding;
  if (options.kind == FormSurfaceKind::plane)
    return std::make_unique<PlaneSurface>(options.height, options.slope[0], options.slope[1]);
  if (options.kind == FormSurfaceKind::paraboloid)
    return std::make_unique<ParaboloidSurface>(options.height, options.centre[0], options.centre[1],
                                               *options.focal_length);
  MatX heights(options.x.size(), options.y.size());
  for (Eigen::Index i = 0; i < heights.rows(); ++i)
    for (Eigen::Index j = 0; j < heights.cols(); ++j)
      heights(i, j) = options.heights[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return std::make_unique<TableSurface>(options.x, options.y, heights);
}

void bind_to_surface(const Context& context, const FormFindingOptions& options, FormNet& form) {
  if (options.surface) form.own_surface = make_surface(*options.surface);
  form.surface = form.own_surface ? form.own_surface.get() : nullptr;
  if (context.surface) form.surface = &*context.surface;
  if (form.surface == nullptr || options.on_surface.empty()) return;
  form.net.on_surface.assign(form.nodes.size(), false);
  for (const int i : form.nodes_of(context.structure, options.on_surface)) form.net.on_surface[i] = true;
}

}  // namespace

double FormNet::stiffness(const model::Model& structure, std::size_t branch) const {
  return structure.axial_stiffness(structure.cables[cables[branch]]);
}

std::vector<int> FormNet::branches_of(const model::Model& structure,
                                      const std::vector<std::string>& names) const {
  std::vector<int> branches;
  for (const auto& name : names) {
    if (std::find(groups.begin(), groups.end(), name) == groups.end())
      throw ModelError(fmt::format("form-finding: \"{}\" is not a part of the net, which is made of {}", name,
                                   fmt::join(groups, ", ")));
    const int group = structure.find_group(name);
    for (std::size_t b = 0; b < cables.size(); ++b)
      if (structure.cables[cables[b]].group == group) branches.push_back(static_cast<int>(b));
  }
  return branches;
}

std::vector<int> FormNet::nodes_of(const model::Model& structure,
                                   const std::vector<std::string>& names) const {
  std::vector<int> found;
  for (const auto& name : names)
    for (const int node : structure.nodes_of({name})) {
      if (local[node] < 0)
        throw ModelError(fmt::format("form-finding: the node at {} of \"{}\" is not a part of the net",
                                     place(structure.nodes[node]), name));
      found.push_back(local[node]);
    }
  return found;
}

std::string FormNet::describe(const model::Model& structure, int branch) const {
  const auto& cable = structure.cables[cables[branch]];
  int number = 1;
  for (int b = 0; b < branch; ++b) number += structure.cables[cables[b]].group == cable.group ? 1 : 0;
  return fmt::format("cable {} of {}, from {} to {}", number, structure.groups[cable.group].name,
                     place(structure.nodes[cable.nodes[0]]), place(structure.nodes[cable.nodes[1]]));
}

FormNet extract_net(const Context& context, const FormFindingOptions& options) {
  FormNet form;
  form.groups = net_groups(context, options);
  form.cloth = cloth_groups(context, options);
  add_branches(context.structure, form);
  add_cloth(context.structure, form);
  hold_nodes(context.structure, options, form);
  add_loads(context, options, form);
  bind_to_surface(context, options, form);
  return form;
}

}  // namespace tautline::steps
