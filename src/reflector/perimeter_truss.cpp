#include <fmt/format.h>

#include <reflector/triangular_nets.hpp>
#include <tautline/core/error.hpp>
#include <tautline/reflector/perimeter_truss.hpp>
#include <utility>

namespace tautline::reflector {

namespace {

constexpr int fewest_struts = 3;

/// Adds the parts of the reflector to a model, one group after the other.
class Builder : TriangularNets {
 public:
  Builder(const PerimeterTrussOptions& options, int struts)
      : TriangularNets(options), options_(options), n_struts_(struts) {}

  model::Model build();

 private:
  int strut_rim_node(int strut) const { return lattice_.rim(strut * (lattice_.n_rim() / n_struts_)); }
  void add_frame();
  void add_diagonals();

  const PerimeterTrussOptions& options_;
  int n_struts_;
};

model::Model Builder::build() {
  add_net_nodes();
  add_nets_and_ties();
  if (options_.diagonals) add_diagonals();
  add_frame();
  add_cloth();
  add_net_selections();
  return std::move(model_);
}

void Builder::add_diagonals() {
  const int group = add_group("diagonals", model::ElementKind::cable);
  for (int strut = 0; strut < n_struts_; ++strut) {
    const int here = strut_rim_node(strut), next = strut_rim_node(strut + 1);
    model_.cables.push_back({{here, rear(next)}, group});
    model_.cables.push_back({{next, rear(here)}, group});
  }
}

void Builder::add_frame() {
  const auto add_rim = [&](const std::string& name, int first_node) {
    const int group = add_group(name, model::ElementKind::beam);
    model_.groups[group].orientation = Vec3::UnitZ();
    for (int j = 0; j < lattice_.n_rim(); ++j)
      model_.beams.push_back({{first_node + lattice_.rim(j), first_node + lattice_.rim(j + 1)}, group});
  };
  add_rim("front_rim", 0);
  add_rim("rear_rim", lattice_.n_nodes());

  const int struts = add_group("struts", model::ElementKind::beam);
  std::vector<std::vector<int>> beams;
  for (int strut = 0; strut < n_struts_; ++strut) {
    const int node = strut_rim_node(strut);
    beams.push_back({static_cast<int>(model_.beams.size())});
    model_.beams.push_back({{node, rear(node)}, struts});
    model_.selections[fmt::format("strut_{}", strut)].beams = beams.back();
  }
  hold_strut(beams, options_.held_strut);
}

/// Number of struts. @throws ModelError where rings, gap or struts make no truss.
int check_truss(const PerimeterTrussOptions& options) {
  check_triangular_nets(options);
  const int n_rim = 6 * options.rings;
  const int struts = options.struts == 0 ? n_rim / 2 : options.struts;
  if (struts >= fewest_struts && n_rim % struts == 0) return struts;
  std::string possible;
  for (int n = fewest_struts; n <= n_rim; ++n)
    if (n_rim % n == 0) possible += fmt::format("{}{}", possible.empty() ? "" : ", ", n);
  throw ModelError(fmt::format(
      "{} struts cannot be spread evenly over the {} nodes of the rim (6 for each of {} rings); possible: {}",
      struts, n_rim, options.rings, possible));
}

}  // namespace

model::Model make_perimeter_truss(const PerimeterTrussOptions& options) {
  const int struts = check_truss(options);
  return Builder(options, struts).build();
}

}  // namespace tautline::reflector
