#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model.hpp>

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

  std::string element(const char* kind, std::size_t index, int group) const {
    return fmt::format("{} {} of group \"{}\"", kind, index + 1, model_.groups[group].name);
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
  const int n_nodes = static_cast<int>(model.nodes.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto& nodes = elements[i].nodes;
    const std::string who = faults.element(kind, i, elements[i].group);
    if (model.groups[elements[i].group].kind != expected)
      faults.add("{}: the group's section is of another kind", who);
    bool known = true;
    for (const int node : nodes) known = known && node >= 0 && node < n_nodes;
    if (!known) {
      faults.add("{}: refers to a node that does not exist", who);
      continue;
    }
    for (std::size_t k = 1; k < nodes.size(); ++k)
      if ((model.nodes[nodes[k]] - model.nodes[nodes[k - 1]]).norm() <= smallest)
        faults.add("{}: its nodes {} and {} are at the same place", who, nodes[k - 1] + 1, nodes[k] + 1);
  }
}

void check_groups(const Model& model, Faults& faults) {
  for (const auto& group : model.groups) {
    const auto positive = [&](double value, const char* what) {
      if (!(value > 0) || !std::isfinite(value))
        faults.add("group \"{}\": {} must be positive, is {:g}", group.name, what, value);
    };
    if (group.kind == ElementKind::cable)
      positive(group.cable.axial_stiffness, "the axial stiffness E A [N]");
    if (group.kind == ElementKind::membrane)
      positive(group.membrane.tension_stiffness, "the tension stiffness E h [N/m]");
    if (group.kind == ElementKind::beam) {
      positive(group.beam.axial_stiffness, "the axial stiffness E A [N]");
      positive(group.beam.bending_stiffness_2, "the bending stiffness about axis 2 [N m^2]");
      positive(group.beam.bending_stiffness_3, "the bending stiffness about axis 3 [N m^2]");
      positive(group.beam.torsion_stiffness, "the torsion stiffness [N m^2]");
    }
  }
}

/// The bound is far above the round-off of three points in a line and far below any facet of use.
void check_areas(const Model& model, Faults& faults) {
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    const auto& [a, b, c] = model.membranes[i].nodes;
    const Vec3 ab = model.nodes[b] - model.nodes[a], ac = model.nodes[c] - model.nodes[a];
    if (ab.cross(ac).norm() <= 1e-10 * std::max(ab.squaredNorm(), ac.squaredNorm()))
      faults.add("{}: has no area", faults.element("membrane", i, model.membranes[i].group));
  }
}

void check_connection(const Model& model, Faults& faults) {
  std::vector<bool> used(model.nodes.size(), false);
  for (const auto& element : model.cables)
    for (const int node : element.nodes) used[node] = true;
  for (const auto& element : model.beams)
    for (const int node : element.nodes) used[node] = true;
  for (const auto& element : model.membranes)
    for (const int node : element.nodes) used[node] = true;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) faults.add("node {} belongs to no element: remove it or connect it", i + 1);
  if (model.supports.empty())
    faults.add("nothing is supported: the structure can move as a rigid body; add an entry to \"supports\"");
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
  faults.raise();
  check_areas(model, faults);
  check_connection(model, faults);
  faults.raise();
}

}  // namespace tautline::model
