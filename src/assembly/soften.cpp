// Elements that only pull: what they would resist if they were taut, and with a limit to their stiffness.
// Theory: docs/theory/newton.md
#include <algorithm>
#include <cmath>

#include <tautline/assembly/system.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/response.hpp>

#include "assembly/expansion.hpp"
#include "assembly/own_elements.hpp"

namespace tautline::assembly {

using element::Want;

namespace {

double& stiffest(element::MembraneSection& section) {
  return section.tension_stiffness_2 > section.tension_stiffness ? section.tension_stiffness_2
                                                                 : section.tension_stiffness;
}

void scale(element::MembraneSection& section, double factor) {
  section.tension_stiffness *= factor;
  section.tension_stiffness_2 *= factor;
  section.shear_stiffness *= factor;
}

/// Whether a sheet resists motions in every direction: it pulls both ways.
template <int N>
bool is_taut(const model::Model& model, const model::State& state, const model::Membrane& sheet) {
  const auto answer = element::evaluate_membrane<N>(model::membrane_law<N>(model, sheet),
                                                    model::reference_nodes<N>(model, sheet.nodes),
                                                    model::displacements<N>(state, sheet.nodes), Want::force);
  return answer.state == element::MembraneState::taut && answer.principal_cauchy[1] > 0;
}

/// What a row of the element's tangent would sum up to if it were taut; zero if it is.
double missing_stiffness(const model::Model& model, const model::State& state, const model::Cable& cable) {
  if (!model::is_slack(model, state, cable)) return 0;
  return 2 * model.axial_stiffness(cable) / model.unstressed_length(cable);
}

double missing_stiffness(const model::Model& model, const model::State& state, const model::Membrane& sheet) {
  auto section = model.groups[sheet.group].membrane;
  const bool taut =
      sheet.nodes.size() == 3 ? is_taut<3>(model, state, sheet) : is_taut<4>(model, state, sheet);
  if (taut) return 0;
  double side = 0, area = 0;
  for (int k = 0, n = sheet.nodes.size(); k < n; ++k) {
    const Vec3& origin = model.nodes[sheet.nodes[0]];
    const Vec3 &a = model.nodes[sheet.nodes[k]], &b = model.nodes[sheet.nodes[(k + 1) % n]];
    side = std::max(side, (b - a).squaredNorm());
    area += (a - origin).cross(b - origin).norm() / 2;
  }
  return 2 * stiffest(section) * side / area;
}

template <class Element>
double missing_stiffness(const model::Model&, const model::State&, const Element&) {
  return 0;
}

}  // namespace

bool System::taut_stiffness(la::Vector& sums) const {
  std::vector<double> all(origin_.size(), 0.0);
  double most = 0;
  for_each_own([&](const auto& element) {
    const double k = missing_stiffness(model_, state_, element);
    if (k == 0) return;
    most = std::max(most, k);
    const Expansion expansion(kinematics_, map_, element.nodes, false);
    expansion.add(VecX::Constant(3 * static_cast<Eigen::Index>(element.nodes.size()), k).eval(), all);
  });
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = held()[i] ? 0 : std::abs(all[i]);
  sums.write(own_part(all));
  return la::max_over_ranks(most) > 0;
}

double System::soften(double limit) {
  if (own_) {
    for (std::size_t i = 0; i < model_.cables.size(); ++i)
      model_.cables[i].stiffness_factor = own_->factor[i];
    for (const auto& [group, section] : own_->sheet) model_.groups[group].membrane = section;
    support_stiffness_ = own_->support;
    own_.reset();
  }
  if (!std::isfinite(limit)) return 1;
  own_.emplace();
  own_->support = support_stiffness_;
  double largest = 1;
  for (auto& cable : model_.cables) {
    own_->factor.push_back(cable.stiffness_factor);
    const double ratio = model_.axial_stiffness(cable) / limit;
    if (!model::only_pulls(model_, cable) || ratio <= 1) continue;
    cable.stiffness_factor /= ratio;
    largest = std::max(largest, ratio);
  }
  // A sheet carries over a width what a cable carries alone.
  const double per_width = limit * std::sqrt(static_cast<double>(model_.nodes.size())) / size_;
  for (std::size_t i = 0; i < model_.groups.size(); ++i) {
    auto& group = model_.groups[i];
    if (group.kind != model::ElementKind::membrane) continue;
    const double ratio = stiffest(group.membrane) / per_width;
    if (!(ratio > 1)) continue;
    own_->sheet[i] = group.membrane;
    scale(group.membrane, 1 / ratio);
    largest = std::max(largest, ratio);
  }
  support_stiffness_ /= largest;
  return largest;
}

}  // namespace tautline::assembly
