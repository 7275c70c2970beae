#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/names.hpp>

#include "model/detail/load_faults.hpp"

namespace tautline::model {

namespace {

/// Collects faults; a group's name stands beside every element.
class Faults {
 public:
  explicit Faults(const Model& model) : model_(model) {}

  template <class... Args>
  void add(fmt::format_string<Args...> text, Args&&... args) {
    faults_.push_back(fmt::format(text, std::forward<Args>(args)...));
  }

  void add(std::vector<std::string> more) { faults_.insert(faults_.end(), more.begin(), more.end()); }

  std::string element(const char* kind, std::size_t index, int group) const {
    return element_name(model_, kind, index, group);
  }

  void raise() const {
    if (faults_.empty()) return;
    throw ModelError(fmt::format("the structure cannot be analysed:\n  {}", join(faults_, "\n  ")));
  }

 private:
  const Model& model_;
  std::vector<std::string> faults_;
};

template <class Elements>
void check_elements(const Model& model, const Elements& elements, const char* kind, ElementKind expected,
                    double smallest, Faults& faults) {
  const auto fits = [&](ElementKind found) {
    return expected == ElementKind::cable ? is_cable_like(found) : found == expected;
  };
  const int n_nodes = static_cast<int>(model.nodes.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto& nodes = elements[i].nodes;
    const std::string who = faults.element(kind, i, elements[i].group);
    if (!fits(model.groups[elements[i].group].kind))
      faults.add("{}: the group's section is of another kind", who);
    bool known = true;
    for (const int node : nodes) known = known && node >= 0 && node < n_nodes;
    if (!known) {
      faults.add("{}: refers to a node that does not exist", who);
      continue;
    }
    const int n = static_cast<int>(nodes.size());
    for (int k = 1; k < n && smallest > 0; ++k)
      if ((model.nodes[nodes[k]] - model.nodes[nodes[k - 1]]).norm() <= smallest)
        faults.add("{}: its {} and {} are at the same place", who, node_name(model, nodes[k - 1]),
                   node_at(model, nodes[k]));
  }
}

void check_groups(const Model& model, Faults& faults) {
  for (const auto& group : model.groups) {
    const auto positive = [&](double value, const char* what) {
      if (!(value > 0) || !std::isfinite(value))
        faults.add("group \"{}\": {} must be positive, is {:g}", group.name, what, value);
    };
    if (is_cable_like(group.kind)) positive(group.cable.axial_stiffness, "the axial stiffness E A [N]");
    if (group.kind == ElementKind::membrane)
      positive(group.membrane.tension_stiffness, "the tension stiffness E h [N/m]");
    if (group.kind == ElementKind::shell) {
      positive(group.shell.young_modulus, "Young's modulus [Pa]");
      positive(group.shell.thickness, "the thickness [m]");
    }
    if (group.kind == ElementKind::beam) {
      positive(group.beam.axial_stiffness, "the axial stiffness E A [N]");
      positive(group.beam.bending_stiffness_2, "the bending stiffness about axis 2 [N m^2]");
      positive(group.beam.bending_stiffness_3, "the bending stiffness about axis 3 [N m^2]");
      positive(group.beam.torsion_stiffness, "the torsion stiffness [N m^2]");
    }
  }
}

/// The bound is far above the round-off of three points in a line and far below any facet of use.
template <class Facets>
void check_areas(const Model& model, const Facets& facets, const char* kind, Faults& faults) {
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const auto& nodes = facets[i].nodes;
    const int n = nodes.size();
    Vec3 normal = Vec3::Zero();
    for (int k = 0; k < n; ++k) {
      const Vec3& here = model.nodes[nodes[k]];
      const Vec3 out = model.nodes[nodes[(k + 1) % n]] - here,
                 in = model.nodes[nodes[(k + n - 1) % n]] - here;
      const Vec3 corner = out.cross(in);
      const bool flat = corner.norm() <= 1e-10 * std::max(out.squaredNorm(), in.squaredNorm());
      if (flat && n == 3) {
        faults.add("{}: has no area", faults.element(kind, i, facets[i].group));
        break;
      }
      if (k > 0 && n == 4 && (flat || corner.dot(normal) <= 0)) {
        faults.add("{}: is not convex, or its nodes are not in order around it",
                   faults.element(kind, i, facets[i].group));
        break;
      }
      normal = corner;
    }
  }
}

/// The rotation of a follower is its leader's, or turned against it: no support holds it.
void check_held_rotations(const Model& model, Faults& faults) {
  std::vector<bool> turns_with(model.nodes.size(), false);
  for (const auto& link : model.links)
    if (!link.rotation_free) turns_with[link.follower] = true;
  for (const auto& pair : model.cyclic_pairs) turns_with[pair.follower] = true;
  for (const auto& support : model.supports) {
    const auto& fixed = support.fixed;
    const bool moves = !fixed[0] && !fixed[1] && !fixed[2];  // else told already
    if (!moves || !(fixed[3] || fixed[4] || fixed[5])) continue;
    for (const int node : support.nodes)
      if (turns_with[node])
        faults.add("support \"{}\" holds the rotation of {}, which turns with another node: support that one",
                   support.name, node_at(model, node));
  }
}

/// A follower follows one leader; the faces of a sector lead by no other link.
void check_links(const Model& model, Faults& faults) {
  std::vector<int> followed(model.nodes.size(), 0);
  const auto count = [&](const auto& pairs) {
    for (const auto& pair : pairs) ++followed[pair.follower];
  };
  count(model.links);
  count(model.cyclic_pairs);
  for (std::size_t i = 0; i < followed.size(); ++i)
    if (followed[i] > 1)
      faults.add("{} follows {} other nodes through links: it can follow one only",
                 node_at(model, static_cast<int>(i)), followed[i]);
  const auto chain = [&](const auto& pairs) {
    for (const auto& pair : pairs)
      if (followed[pair.leader] > 0)
        faults.add("{} leads {} through a link and follows another node itself: link both to the same node",
                   node_at(model, pair.leader), node_name(model, pair.follower));
  };
  chain(model.cyclic_pairs);
  links_in_order(model);
  std::vector<bool> turned(model.nodes.size(), false);
  for (const auto& link : model.links) turned[link.follower] = !link.rotation_free;
  for (const auto& pair : model.cyclic_pairs) turned[pair.follower] = true;
  for (const auto& support : model.supports)
    for (const int node : support.nodes) {
      const bool rotation = support.fixed[3] || support.fixed[4] || support.fixed[5];
      if (rotation && turned[node])
        faults.add(
            "support \"{}\" holds a rotation of {}, which turns with another node through a link: support "
            "that one",
            support.name, node_at(model, node));
      const bool held = support.fixed[0] || support.fixed[1] || support.fixed[2];
      if (held && followed[node] > 0)
        faults.add("support \"{}\" holds {}, which follows another node through a link: support that one",
                   support.name, node_at(model, node));
    }
  check_held_rotations(model, faults);
}

void check_connection(const Model& model, Faults& faults) {
  std::vector<bool> used(model.nodes.size(), false);
  for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements)
      for (const int node : element.nodes) used[node] = true;
  });
  for (const auto& link : model.links) used[link.leader] = used[link.follower] = true;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i])
      faults.add("{} belongs to no element: remove it or connect it", node_at(model, static_cast<int>(i)));
}

}  // namespace

void validate(const Model& model) {
  Faults faults(model);
  if (model.nodes.empty()) faults.add("it has no nodes");
  double size = 0;
  for (const auto& node : model.nodes) size = std::max(size, (node - model.nodes.front()).norm());
  const double smallest = 1e-12 * size;
  check_groups(model, faults);
  check_elements(model, model.cables, "cable", ElementKind::cable, smallest, faults);
  check_elements(model, model.beams, "beam", ElementKind::beam, smallest, faults);
  check_elements(model, model.membranes, "membrane", ElementKind::membrane, smallest, faults);
  check_elements(model, model.shells, "shell", ElementKind::shell, smallest, faults);
  check_elements(model, model.springs, "spring", ElementKind::spring, 0, faults);
  check_elements(model, model.masses, "mass", ElementKind::mass, 0, faults);
  faults.raise();
  check_areas(model, model.membranes, "membrane", faults);
  check_areas(model, model.shells, "shell", faults);
  check_links(model, faults);
  check_connection(model, faults);
  faults.raise();
  faults.add(detail::load_faults(model));
  faults.raise();
}

}  // namespace tautline::model
