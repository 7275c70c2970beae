#include <tautline/model/tube_shells.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

namespace tautline::model {

namespace {

/// Radius of the nodes over that of the tube, so that n flat sides have its second moment of area.
double widening(int n) {
  const double half = std::numbers::pi / n, s = std::sin(half);
  return std::cbrt(half / (s * (1 - 2 * s * s / 3)));
}

class TubeBuilder {
 public:
  TubeBuilder(const Model& structure, const TubeShellOptions& options)
      : old_(structure), new_(structure), options_(options), widening_(widening(options.around)) {
    check_counts();
    for (const auto& name : options.groups) wanted_.push_back(checked_group(name));
    check_loads();
  }

  Model run() {
    for (const int group : wanted_) make_shell_group(new_.groups[static_cast<std::size_t>(group)]);
    new_.beams.clear();
    std::vector<int> kept(old_.beams.size(), -1);
    std::vector<std::vector<int>> shells(old_.beams.size());
    for (std::size_t i = 0; i < old_.beams.size(); ++i) {
      if (wanted(old_.beams[i].group)) {
        shells[i] = build(old_.beams[i]);
        continue;
      }
      kept[i] = static_cast<int>(new_.beams.size());
      new_.beams.push_back(old_.beams[i]);
    }
    for (auto& [name, selection] : new_.selections) {
      for (const int beam : std::exchange(selection.beams, {})) {
        if (kept[beam] >= 0) selection.beams.push_back(kept[beam]);
        selection.shells.insert(selection.shells.end(), shells[beam].begin(), shells[beam].end());
      }
    }
    return std::move(new_);
  }

 private:
  void check_counts() const {
    if (options_.around < 20 || options_.along < 1)
      throw ModelError(fmt::format(
          "tubes_as_shells: at least 20 elements around and 1 along a tube are needed, not {} and {}",
          options_.around, options_.along));
    if (!old_.initial.empty())
      throw ModelError("tubes_as_shells: a structure that starts moved keeps its beams");
  }

  int checked_group(const std::string& name) const {
    const int index = old_.find_group(name);
    if (index < 0) throw ModelError(fmt::format("tubes_as_shells: no group is called \"{}\"", name));
    const auto& group = old_.groups[static_cast<std::size_t>(index)];
    if (group.kind != ElementKind::beam || !group.tube)
      throw ModelError(
          fmt::format("tubes_as_shells: \"{}\" has no section of kind tube or tapered_tube", name));
    if (group.tube->thickness[0] != group.tube->thickness[1])
      throw ModelError(
          fmt::format("tubes_as_shells: the wall of \"{}\" tapers from {:g} to {:g} m; shells of a "
                      "group have one thickness",
                      name, group.tube->thickness[0], group.tube->thickness[1]));
    return index;
  }

  void check_loads() const {
    for (const auto& load : old_.loads) {
      if (load.line_force.isZero(0) && load.line_moment.isZero(0)) continue;
      for (const auto& on : load.on)
        for (const int beam : old_.select(on).beams)
          if (const int group = old_.beams[beam].group; wanted(group))
            throw ModelError(
                fmt::format("tubes_as_shells: load \"{}\" is a line load on \"{}\": only beams bear such",
                            load.name, old_.groups[group].name));
    }
  }

  bool wanted(int group) const { return std::find(wanted_.begin(), wanted_.end(), group) != wanted_.end(); }

  static void make_shell_group(Group& group) {
    const auto& material = group.tube->material;
    group.kind = ElementKind::shell;
    group.shell = {};
    group.shell.young_modulus = material.young_modulus;
    group.shell.poisson_ratio = material.poisson_ratio;
    group.shell.thickness = group.tube->thickness[0];
    group.shell.density = material.density;
    group.shell.thermal_expansion = material.thermal_expansion;
    group.orientation = Vec3::Zero();
    group.taper.reset();
  }

  /// New nodes round the beam at `place` along it, 0 to 1.
  std::vector<int> ring(const Beam& beam, double place) {
    const auto& diameter = old_.groups[beam.group].tube->diameter;
    const double along = beam.span[0] + (beam.span[1] - beam.span[0]) * place;
    const double radius = widening_ * ((1 - along) * diameter[0] + along * diameter[1]) / 2;
    const Vec3 centre = (1 - place) * old_.nodes[beam.nodes[0]] + place * old_.nodes[beam.nodes[1]];
    std::vector<int> nodes;
    for (int k = 0; k < options_.around; ++k) {
      const double angle = 2 * std::numbers::pi * k / options_.around;
      nodes.push_back(static_cast<int>(new_.nodes.size()));
      new_.nodes.push_back(
          centre + radius * (std::cos(angle) * beam.frame.col(1) + std::sin(angle) * beam.frame.col(2)));
    }
    return nodes;
  }

  std::vector<int> build(const Beam& beam) {
    std::vector<int> shells;
    const auto tie = [&](int leader, const std::vector<int>& nodes) {
      for (const int node : nodes) new_.links.push_back({leader, node, false, {}, beam.group});
    };
    auto last = ring(beam, 0);
    tie(beam.nodes[0], last);
    for (int i = 1; i <= options_.along; ++i) {
      auto next = ring(beam, static_cast<double>(i) / options_.along);
      for (int k = 0; k < options_.around; ++k) {
        const int other = (k + 1) % options_.around;
        Shell shell;
        shell.director.fill(Vec3::Zero());                                     // found later
        shell.nodes = FacetNodes(last[k], last[other], next[other], next[k]);  // normals point outwards
        shell.group = beam.group;
        shell.parent = static_cast<int>(new_.shells.size());
        shells.push_back(shell.parent);
        new_.shells.push_back(shell);
      }
      last = std::move(next);
    }
    tie(beam.nodes[1], last);
    return shells;
  }

  const Model& old_;
  Model new_;
  const TubeShellOptions& options_;
  double widening_;
  std::vector<int> wanted_;
};

}  // namespace

Model tubes_as_shells(const Model& structure, const TubeShellOptions& options) {
  return TubeBuilder(structure, options).run();
}

}  // namespace tautline::model
