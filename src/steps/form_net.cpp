#include "steps/form_net.hpp"

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>

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
  auto groups = groups_of_kind(context.structure, model::ElementKind::cable);
  if (options.method != FormMethod::self_stress) return groups;
  const auto bars = groups_of_kind(context.structure, model::ElementKind::bar);
  groups.insert(groups.end(), bars.begin(), bars.end());
  return groups;
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
  const auto n = static_cast<Eigen::Index>(form.cables.size());
  form.drawn_tension = form.drawn_length = form.unstressed_length = VecX(n);
  for (Eigen::Index b = 0; b < n; ++b) {
    const auto& cable = structure.cables[form.cables[static_cast<std::size_t>(b)]];
    form.net.branches.push_back({form.local[cable.nodes[0]], form.local[cable.nodes[1]]});
    form.drawn_tension[b] = cable.initial_strain * structure.axial_stiffness(cable);
    form.drawn_length[b] = structure.reference_length(cable);
    form.unstressed_length[b] = structure.unstressed_length(cable);
  }
}

/// Whether the method takes films whose stress is not the same in all directions.
bool takes_unequal_stress(FormMethod method) {
  return method == FormMethod::film || method == FormMethod::dynamic_relaxation;
}

/// What the deck asks for; single facets may have been changed by an earlier step [N/m].
std::array<double, 2> asked_prestress(const Context& context, const model::GroupOptions& group) {
  if (group.prestress) return *group.prestress;
  const auto* cloth = std::get_if<model::MembraneSectionOptions>(&context.deck.sections.at(group.section));
  if (!group.initial_stress || cloth == nullptr) return {0, 0};
  const double thickness = cloth->thickness.value_or(0);
  return {(*group.initial_stress)[0] * thickness, (*group.initial_stress)[1] * thickness};
}

void add_cloth(const Context& context, const FormFindingOptions& options, FormNet& form) {
  const auto& structure = context.structure;
  for (const auto& name : form.cloth)
    for (const int i : structure.select(name).membranes) {
      const auto& membrane = structure.membranes[i];
      const auto& group = structure.groups[membrane.group];
      const auto stress = asked_prestress(context, context.deck.groups.at(group.name));
      if (!(std::min(stress[0], stress[1]) > 0) ||
          (stress[0] != stress[1] && !takes_unequal_stress(options.method)))
        throw ModelError(fmt::format(
            "form-finding: the cloth \"{}\" needs a prestress > 0 in all directions{}, not {:.4g} and {:.4g} "
            "N/m: give its group `prestress`",
            name, takes_unequal_stress(options.method) ? "" : ", one number", stress[0], stress[1]));
      formfinding::FilmFacet facet{membrane.nodes, stress, model::axis_1(group)};
      const auto local = [&](int k) { return form.local[membrane.nodes[k]]; };
      facet.nodes = membrane.nodes.size() == 3 ? model::FacetNodes(local(0), local(1), local(2))
                                               : model::FacetNodes(local(0), local(1), local(2), local(3));
      form.film.push_back(facet);
      form.membranes.push_back(i);
    }
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
    throw ModelError(
        fmt::format("{}: step \"{}\" names it, but form-finding takes no loads but forces on nodes "
                    "(`force`); leave the others "
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

bool FormNet::is_bar(const model::Model& structure, int branch) const {
  const auto& cable = structure.cables[cables[static_cast<std::size_t>(branch)]];
  return structure.groups[cable.group].kind == model::ElementKind::bar;
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

std::string FormNet::node_name(const Context& context, int node) const {
  const auto i = static_cast<std::size_t>(nodes[static_cast<std::size_t>(node)]);
  const std::string at = place(context.structure.nodes[i]);
  const bool named = context.deck.model && i < context.deck.model->nodes.size();
  return named ? fmt::format("node \"{}\" at {}", context.deck.model->nodes[i].first, at)
               : fmt::format("the node at {}", at);
}

ModelError named(const Context& context, const FormNet& form, const formfinding::NetError& error) {
  return ModelError("form-finding: " +
                    error.with([&](int node) { return form.node_name(context, node); },
                               [&](int branch) { return form.describe(context.structure, branch); }));
}

FormNet extract_net(const Context& context, const FormFindingOptions& options) {
  FormNet form;
  form.groups = net_groups(context, options);
  form.cloth = cloth_groups(context, options);
  add_branches(context.structure, form);
  add_cloth(context, options, form);
  hold_nodes(context.structure, options, form);
  add_loads(context, options, form);
  bind_to_surface(context, options, form);
  return form;
}

}  // namespace tautline::steps
