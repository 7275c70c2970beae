#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <reflector/triangular_nets.hpp>
#include <tautline/core/error.hpp>
#include <tautline/reflector/tensegrity_rim.hpp>
#include <utility>

namespace tautline::reflector {

namespace {

/// Adds the parts of the reflector to a model, one group after the other.
class Builder : TriangularNets {
 public:
  explicit Builder(const TensegrityRimOptions& options) : TriangularNets(options), options_(options) {}

  model::Model build();

 private:
  int n_struts() const { return lattice_.n_rim(); }
  int front_knee(int strut) const { return 2 * lattice_.n_nodes() + strut % n_struts(); }
  int rear_knee(int strut) const { return front_knee(strut) + n_struts(); }
  int rim(int j) const { return rear_knee((j + n_struts()) % n_struts()) + n_struts(); }
  void add_frame_nodes();
  void add_cords();
  void add_frame();

  const TensegrityRimOptions& options_;
};

model::Model Builder::build() {
  add_net_nodes();
  add_frame_nodes();
  add_nets_and_ties();
  add_cords();
  add_frame();
  add_cloth();
  add_net_selections();
  for (int k = 0; k < n_struts(); ++k) {
    model_.selections["rim_nodes"].nodes.push_back(rim(k));
    for (const int knee : {front_knee(k), rear_knee(k)}) model_.selections["knees"].nodes.push_back(knee);
  }
  return std::move(model_);
}

void Builder::add_frame_nodes() {
  for (const bool front : {true, false})
    for (int k = 0; k < n_struts(); ++k) {
      const Vec3 &above = model_.nodes[lattice_.rim(k)], &below = model_.nodes[rear(lattice_.rim(k))];
      const double height = (1 + (front ? 1 : -1) * options_.middle_link) / 2;
      model_.nodes.push_back(below + height * (above - below));
    }
  const double radius = options_.aperture / 2 + options_.rim_offset;
  for (int k = 0; k < n_struts(); ++k) {
    const double between = options_.cord_reach - std::floor(options_.cord_reach);
    const double azimuth = 2 * std::numbers::pi * (k + between) / n_struts();
    model_.nodes.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), -options_.gap / 2);
  }
}

void Builder::add_cords() {
  const int behind = static_cast<int>(std::floor(options_.cord_reach));
  const int before = -static_cast<int>(std::ceil(options_.cord_reach));
  const auto add = [&](const std::string& name, auto front, auto rear_one) {
    const int group = add_group(name, model::ElementKind::cable);
    for (int k = 0; k < n_struts(); ++k)
      for (const int node : {front(k), rear_one(k)})
        for (const int step : {before, behind}) model_.cables.push_back({{node, rim(k + step)}, group});
  };
  add(
      "end_cords", [&](int k) { return lattice_.rim(k); }, [&](int k) { return rear(lattice_.rim(k)); });
  if (options_.knee_cords)
    add(
        "knee_cords", [&](int k) { return front_knee(k); }, [&](int k) { return rear_knee(k); });
}

void Builder::add_frame() {
  const int ring = add_group("rim", model::ElementKind::beam);
  model_.groups[ring].orientation = Vec3::UnitZ();
  for (int k = 0; k < n_struts(); ++k) model_.beams.push_back({{rim(k), rim(k + 1)}, ring});

  const int ends = add_group("end_links", model::ElementKind::beam);
  const int middles = add_group("middle_links", model::ElementKind::beam);
  std::vector<std::vector<int>> struts;
  for (int k = 0; k < n_struts(); ++k) {
    const int first = static_cast<int>(model_.beams.size()), front = lattice_.rim(k);
    model_.beams.push_back({{front, front_knee(k)}, ends});
    model_.beams.push_back({{front_knee(k), rear_knee(k)}, middles});
    model_.beams.push_back({{rear_knee(k), rear(front)}, ends});
    struts.push_back({first, first + 1, first + 2});
    model_.selections[fmt::format("strut_{}", k)].beams = struts.back();
  }
  hold_strut(struts, options_.held_strut);
}

/// @throws ModelError where the numbers make no rim with struts
void check(const TensegrityRimOptions& options) {
  check_triangular_nets(options);
  const int struts = 6 * options.rings;
  if (!(options.rim_offset > 0))
    throw ModelError(fmt::format(
        "the rim must lie outside the struts, or its cords could not draw them outwards: rim_offset = {:g} m",
        options.rim_offset));
  if (!(options.middle_link > 0 && options.middle_link < 1))
    throw ModelError(fmt::format("middle_link must be between 0 and 1, not {:g}", options.middle_link));
  const double reach = options.cord_reach;
  if (!(reach > 0 && 4 * reach < struts) || 2 * reach != std::floor(2 * reach))
    throw ModelError(fmt::format(
        "cord_reach = {:g} is not one of 0.5, 1, 1.5, ... below a quarter of the {} struts (6 for each ring)",
        reach, struts));
}

}  // namespace

model::Model make_tensegrity_rim(const TensegrityRimOptions& options) {
  check(options);
  return Builder(options).build();
}

}  // namespace tautline::reflector
