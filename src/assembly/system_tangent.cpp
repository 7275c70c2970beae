// Tangents: in the present state, and with stresses of a linear response.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include <Eigen/LU>

#include <tautline/assembly/system.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>

#include "assembly/contribution.hpp"
#include "assembly/expansion.hpp"
#include "assembly/link_terms.hpp"
#include "assembly/own_elements.hpp"
#include <tautline/core/rotation.hpp>

namespace tautline::assembly {

using element::Want;

namespace {

/// A small motion of a body: displacement and rotation vector.
struct Motion {
  Vec3 displacement = Vec3::Zero(), rotation = Vec3::Zero();
};

/// Motions of an element's nodes without the rigid motion that fits them best. One node alone keeps its own.
/// Rotations of nodes settle only what their places leave open: the twist of a line.
template <class Nodes>
std::vector<Motion> deformation(const Points& places, const System::NodalField& field, const Nodes& nodes,
                                bool rotations, double& size) {
  constexpr double open = 1e-8;
  std::vector<Motion> motions;
  Vec3 centre = Vec3::Zero();
  Motion mean;
  for (const int node : nodes) {
    motions.push_back({field.displacement[node], rotations ? field.rotation[node] : Vec3(Vec3::Zero())});
    centre += places[node];
    mean.displacement += motions.back().displacement;
    mean.rotation += motions.back().rotation;
  }
  const auto n = static_cast<double>(motions.size());
  size = 0;
  if (motions.size() < 2) return motions;
  centre /= n;
  mean.displacement /= n;
  mean.rotation /= n;
  Mat3 inertia = Mat3::Zero();
  Vec3 turn = Vec3::Zero();
  std::size_t i = 0;
  for (const int node : nodes) {
    const Vec3 arm = places[node] - centre;
    inertia += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
    turn += arm.cross(motions[i++].displacement - mean.displacement);
  }
  size = std::sqrt(inertia.trace());
  Vec3 rigid = mean.rotation;
  if (size > 0) {
    const double weak = open * size * size;
    rigid = (inertia + weak * Mat3::Identity()).inverse() * (turn + weak * mean.rotation);
  }
  i = 0;
  for (const int node : nodes) {
    motions[i].displacement -= mean.displacement + rigid.cross(places[node] - centre);
    if (rotations) motions[i].rotation -= rigid;
    ++i;
  }
  return motions;
}

/// Puts into `to` the state of an element's nodes with `part` of what deforms it.
template <class Element>
void deform(const model::Model& model, const model::State& from, const Points& places,
            const System::NodalField& field, const Element& element, double part, model::State& to) {
  double size = 0;
  const auto motions = deformation(places, field, element.nodes, uses_rotations(model, element), size);
  std::size_t i = 0;
  for (const int node : element.nodes) {
    to.displacement[node] = from.displacement[node] + part * motions[i].displacement;
    to.rotation[node] = rotation_of(part * motions[i].rotation) * from.rotation[node];
    ++i;
  }
}

bool wrinkles(const model::Model& model, const model::Membrane& membrane) {
  const auto& section = model.groups[static_cast<std::size_t>(membrane.group)].membrane;
  return section.wrinkling && section.tension_stiffness > 0;
}

/// A cable, or a catenary that nothing makes sag.
bool only_pulls(const model::Model& model, const Acting& start, const Acting& end,
                const model::Cable& cable) {
  const auto& group = model.groups[static_cast<std::size_t>(cable.group)];
  if (group.kind == model::ElementKind::cable) return true;
  return group.kind == model::ElementKind::catenary &&
         (group.cable.mass_per_length == 0 || (start.acceleration.isZero(0) && end.acceleration.isZero(0)));
}

/// @brief Tangents of membranes that may wrinkle at places ahead on a ray.
///
/// Two places, the second three times as far, between which the law is smooth: behind them lies what the ray
/// begins with, also where the state of wrinkling changes there. A sheet without any stress gets that of the
/// ray's direction.
class WrinklingOnRay {
 public:
  WrinklingOnRay(const model::Model& model, const model::State& state, const Acting& start, const Acting& end,
                 const System& system, const Ray& ray)
      : model_(model), state_(state), start_(start), end_(end), ray_(ray) {
    if (!system.may_wrinkle()) return;
    places_ = model::positions(model, state);
    rate_ = field_ = system.nodal(*ray.rate);
    if (ray.lambda != 0) way_ = system.nodal(*ray.way);
    stressed_ = state;
  }

  /// Where the ray begins, from ahead.
  Contribution at_start(const model::Membrane& membrane) const {
    const Pair pair = ahead(membrane);
    return {1.5 * pair.near.force - 0.5 * pair.far.force, 1.5 * pair.near.tangent - 0.5 * pair.far.tangent};
  }
  /// Half the change over 2 h, times `sign`.
  Contribution half_change(const model::Membrane& membrane, double sign) const {
    const Pair pair = ahead(membrane);
    const double factor = sign / (2 * pair.part);
    return {factor * (pair.far.force - pair.near.force), factor * (pair.far.tangent - pair.near.tangent)};
  }

 private:
  struct Pair {
    Contribution near, far;
    double part;  ///< of h, at which `near` is
  };
  /// Halves of halves nearer, until the law is smooth between the two.
  Pair ahead(const model::Membrane& membrane) const {
    constexpr double smallest = 1e-3, bent = 0.02, rounding = 1e-9;
    for (double part = 1;; part /= 8) {
      Pair pair{at(membrane, part), at(membrane, 3 * part), part};
      const auto &near = pair.near.tangent, &far = pair.far.tangent;
      const double bend = (near + far - 2 * at(membrane, 2 * part).tangent).norm();
      if (bend <= bent * (far - near).norm() + rounding * far.norm() || part < smallest) return pair;
    }
  }

  Contribution at(const model::Membrane& membrane, double part) const {
    for (const int node : membrane.nodes) {
      field_.displacement[node] = part * ray_.h * rate_.displacement[node];
      if (ray_.lambda != 0) field_.displacement[node] += way_.displacement[node];
    }
    deform(model_, state_, places_, field_, membrane, 1, stressed_);
    const auto index = model_.cables.size() + model_.beams.size() +
                       static_cast<std::size_t>(&membrane - model_.membranes.data());
    const double lambda = ray_.lambda + part * ray_.h;
    model::Membrane warm = membrane;
    warm.temperature_change = (1 - lambda) * start_.temperature[index] + lambda * end_.temperature[index];
    return membrane.nodes.size() == 3 ? evaluated<3>(warm) : evaluated<4>(warm);
  }

  template <int N>
  Contribution evaluated(const model::Membrane& membrane) const {
    const auto answer = element::evaluate_membrane<N>(
        model::membrane_law<N>(model_, membrane), model::reference_nodes<N>(model_, membrane.nodes),
        model::displacements<N>(stressed_, membrane.nodes), Want::tangent);
    return {answer.force, answer.tangent};
  }

  const model::Model& model_;
  const model::State& state_;
  const Acting& start_;
  const Acting& end_;
  const Ray& ray_;
  Points places_;
  System::NodalField rate_, way_;
  mutable System::NodalField field_;  // of the element in hand
  mutable model::State stressed_;
};

}  // namespace

bool System::load_bends(int node) const {
  const bool follows = kinematics_.link_of(node) >= 0;
  const bool by_moment = follows || kinematics_.cyclic_of(node) >= 0 || kinematics_.charted(node);
  if (!by_moment) return false;
  const Vec<6> load = dead_load(node);
  return (follows && !load.head<3>().isZero(0)) || !load.tail<3>().isZero(0);
}

template <class ContributionOf, class Visit>
void System::for_each_stiffness(const ContributionOf& contribution_of, const Visit& visit) const {
  for_each_own([&](const auto& element) {
    auto c = contribution_of(element);
    visit(element.nodes, uses_rotations(model_, element), c.force, c.tangent);
  });
  for_each_pressed([&](const model::FacetNodes& nodes, double pressure) {
    auto c = pressure_contribution(model_, state_, nodes, pressure, Want::tangent);
    c.force = -c.force;
    c.tangent = -c.tangent;
    visit(nodes, false, c.force, c.tangent);
  });
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    if (!load_bends(node)) continue;
    const bool turns = map_.rotational[node];
    const Vec<6> load = -dead_load(node);
    ElementMatrix none = ElementMatrix::Zero(turns ? 6 : 3, turns ? 6 : 3);
    visit(std::array<int, 1>{node}, turns, load, none);
  }
}

template <class ContributionOf>
void System::assemble_tangent(la::SymmetricMatrix& k, const ContributionOf& contribution_of) {
  const Stopwatch watch(assembly_seconds_);
  kinematics_.linearise(state_);
  k.set_zero();
  for_each_stiffness(
      contribution_of, [&](const auto& nodes, bool rotations, const auto& force, auto& values) {
        const Expansion expansion(kinematics_, map_, nodes, rotations);
        if (expansion.plain()) return add_free(expansion.blocks(), values, held(), k);
        const MatX& b = expansion.matrix();
        MatX transformed = b.transpose() * values * b;
        LinkTerms(kinematics_, map_, model_, expansion, transformed).add(nodes, rotations, force);
        add_free(expansion.blocks(), transformed, held(), k);
      });
  for (int block = map_.layout.first; block < map_.layout.first + map_.layout.local; ++block) {
    Mat3 diagonal = Mat3::Zero();
    for (int c = 0; c < 3; ++c)
      if (const auto at = static_cast<std::size_t>(3 * block + c); held()[at])
        diagonal(c, c) = support_stiffness_;
      else if (!bracing_.empty())
        diagonal(c, c) = bracing_[at];
    k.add(std::array<int, 1>{block}, diagonal.data());
  }
  k.finish();
}

void System::tangent(la::SymmetricMatrix& k) {
  assemble_tangent(k, [&](const auto& element) { return answer(state_, element, Want::tangent); });
}

template <class Element>
Contribution System::foretold(const Element& element) const {
  if constexpr (!std::is_same_v<Element, model::Spring> && !std::is_same_v<Element, model::MassElement>) {
    if (last_motion_ && branches_.empty()) {
      const bool turns = uses_rotations(model_, element);
      ElementVector motion((turns ? 6 : 3) * static_cast<Eigen::Index>(element.nodes.size()));
      Eigen::Index row = 0;
      const auto put = [&](const Vec3& part) {
        motion.template segment<3>(row) = part;
        row += 3;
      };
      for (const int node : element.nodes) {
        put(last_motion_->increment.displacement[static_cast<std::size_t>(node)]);
        if (turns) put(last_motion_->increment.rotation[static_cast<std::size_t>(node)]);
      }
      return extrapolated(model_, last_motion_->before, motion, state_, element);
    }
  }
  return answer(state_, element, Want::tangent);
}

/// Of beams only: shells, however short the step, may land in another dent.
bool System::extrapolated_tangent(la::SymmetricMatrix& k) {
  assemble_tangent(k, [&](const auto& element) {
    if constexpr (std::is_same_v<std::decay_t<decltype(element)>, model::Beam>) return foretold(element);
    return answer(state_, element, Want::tangent);
  });
  return last_motion_ && !model_.beams.empty();
}

void System::wholly_extrapolated_tangent(la::SymmetricMatrix& k) {
  assemble_tangent(k, [&](const auto& element) { return foretold(element); });
}

template <class ContributionOf>
std::vector<double> System::product(const std::vector<double>& increment,
                                    const ContributionOf& contribution_of) {
  kinematics_.linearise(state_);
  std::vector<double> product(origin_.size(), 0.0);
  for_each_stiffness(
      contribution_of, [&](const auto& nodes, bool rotations, const auto& force, const auto& values) {
        const Expansion expansion(kinematics_, map_, nodes, rotations);
        if (expansion.plain())
          return expansion.add((values * expansion.template rows_of<VecX>(increment)).eval(), product);
        const MatX& b = expansion.matrix();
        MatX transformed = b.transpose() * values * b;
        LinkTerms(kinematics_, map_, model_, expansion, transformed).add(nodes, rotations, force);
        expansion.add_product(transformed, increment, product);
      });
  return product;
}

std::vector<double> System::stiffness_times(const std::vector<double>& increment) {
  return product(increment, [&](const auto& element) { return answer(state_, element, Want::tangent); });
}

std::vector<double> System::extrapolated_stiffness_times(const std::vector<double>& increment) {
  return product(increment, [&](const auto& element) { return foretold(element); });
}

void System::hold_branches(std::vector<Branch> branches) {
  branches_ = std::move(branches);
}

bool System::may_wrinkle() const {
  return std::any_of(model_.membranes.begin(), model_.membranes.end(),
                     [&](const model::Membrane& m) { return wrinkles(model_, m); });
}

template <class OfWrinkling>
la::SymmetricMatrix System::stressed_tangent(const la::Vector& response, double part,
                                             const OfWrinkling& of_wrinkling) {
  const auto field = nodal(response);
  const auto places = model::positions(model_, state_);
  const double lambda = lambda_;
  apply(part);
  model::State stressed = state_;
  la::SymmetricMatrix k = new_matrix();
  assemble_tangent(k, [&](const auto& element) {
    if constexpr (std::is_same_v<std::decay_t<decltype(element)>, model::Membrane>)
      if (wrinkles(model_, element)) return of_wrinkling(element);
    deform(model_, state_, places, field, element, part, stressed);
    return answer(stressed, element, Want::tangent);
  });
  apply(lambda);
  return k;
}

la::SymmetricMatrix System::stress_change(const Ray& ray) {
  const WrinklingOnRay wrinkling(model_, state_, start_, end_, *this, ray);
  const auto difference = [&](double sign) {
    return stressed_tangent(*ray.rate, sign * ray.h,
                            [&](const auto& membrane) { return wrinkling.half_change(membrane, sign); });
  };
  return difference(1).plus(-1, difference(-1));
}

la::SymmetricMatrix System::tangent_towards(const Ray& ray) {
  const WrinklingOnRay wrinkling(model_, state_, start_, end_, *this, ray);
  la::SymmetricMatrix k = new_matrix();
  assemble_tangent(k, [&](const auto& element) {
    if constexpr (std::is_same_v<std::decay_t<decltype(element)>, model::Membrane>)
      if (wrinkles(model_, element)) return wrinkling.at_start(element);
    return answer(state_, element, Want::tangent);
  });
  return k;
}

la::SymmetricMatrix System::tangent_at(const Ray& ray) {
  la::SymmetricMatrix k = tangent_towards(ray);
  if (ray.lambda == 0) return k;
  la::Vector mean = la::Vector::like(*ray.way);
  mean.copy(*ray.way);
  mean.scale(1 / ray.lambda);
  const double h = ray.h * largest_deformation(*ray.rate) / largest_deformation(mean);
  const auto none = [](const model::Membrane& membrane) {
    const auto n = static_cast<Eigen::Index>(3 * membrane.nodes.size());
    return Contribution{ElementVector::Zero(n), ElementMatrix::Zero(n, n)};
  };
  const auto part = ray.lambda / (2 * h);
  return k.plus(part, stressed_tangent(mean, h, none)).plus(-part, stressed_tangent(mean, -h, none));
}

std::vector<Pull> System::pulls(const la::Vector& rate, double h) {
  const auto field = nodal(rate);
  const auto places = model::positions(model_, state_);
  const double lambda = lambda_;
  std::vector<Pull> result;
  for (int i = 0; i < static_cast<int>(model_.cables.size()); ++i)
    if (only_pulls(model_, start_, end_, model_.cables[static_cast<std::size_t>(i)])) result.push_back({i});
  model::State stressed = state_;
  const auto tension_at = [&](const Pull& pull, double part) {
    const auto& cable = model_.cables[static_cast<std::size_t>(pull.cable)];
    deform(model_, state_, places, field, cable, part, stressed);
    auto data = model::cable_data(model_, cable);
    data.properties.carries_compression = true;
    return element::evaluate_cable(data.properties, data.x_ref,
                                   model::displacements<2>(stressed, cable.nodes), Want::force)
        .tension;
  };
  apply(h);
  for (Pull& pull : result) pull.rate = tension_at(pull, h);
  apply(-h);
  for (Pull& pull : result) pull.rate = (pull.rate - tension_at(pull, -h)) / (2 * h);
  apply(0);
  for (Pull& pull : result) pull.rest = tension_at(pull, 0);
  apply(lambda);
  return result;
}

double System::largest_imposed_strain() const {
  double largest = 0;
  std::size_t next = 0;
  const auto note = [&](const auto& elements, const auto& expansion_of) {
    for (const auto& element : elements) {
      const double change = end_.temperature[next] - start_.temperature[next];
      largest = std::max(largest, std::abs(expansion_of(model_.groups[element.group]) * change));
      ++next;
    }
  };
  const auto of_lines = [](const model::Group& g) { return g.thermal_expansion; };
  note(model_.cables, of_lines);
  note(model_.beams, of_lines);
  note(model_.membranes, [](const model::Group& g) {
    return std::max(std::abs(g.membrane.thermal_expansion), std::abs(g.membrane.thermal_expansion_2));
  });
  note(model_.shells, [](const model::Group& g) { return g.shell.thermal_expansion; });
  for (std::size_t i = 0; i < model_.cables.size(); ++i)
    largest = std::max(largest, std::abs(end_.strain[i] - start_.strain[i]));
  for (std::size_t i = 0; i < model_.beams.size(); ++i) {
    const auto& [a, b] = model_.beams[i].nodes;
    const double length = (model_.nodes[b] - model_.nodes[a]).norm();
    const double bow = model_.groups[model_.beams[i].group].thermal_expansion * length *
                       (end_.temperature_gradient[i] - start_.temperature_gradient[i]).norm();
    largest = std::max(largest, bow);
  }
  return largest;
}

double System::largest_deformation(const la::Vector& response) const {
  const auto field = nodal(response);
  const auto places = model::positions(model_, state_);
  double largest = largest_imposed_strain();
  for_each_own([&](const auto& element) {
    double size = 0;
    for (const auto& motion :
         deformation(places, field, element.nodes, uses_rotations(model_, element), size)) {
      largest = std::max(largest, motion.rotation.norm());
      largest = std::max(largest, motion.displacement.norm() / (size > 0 ? size : size_));
    }
  });
  return la::max_over_ranks(largest);
}

std::vector<double> System::largest_strains(const la::Vector& response) const {
  const auto field = nodal(response);
  const auto places = model::positions(model_, state_);
  std::vector<double> largest(model_.groups.size(), 0.0);
  std::size_t next = 0;
  const auto note = [&](const auto& elements, const auto& expansion_of) {
    for (const auto& element : elements) {
      const double change = end_.temperature[next] - start_.temperature[next];
      const double free = expansion_of(model_.groups[element.group]) * change;
      ++next;
      const std::size_t n = element.nodes.size(), sides = n == 2 ? 1 : n;
      double& most = largest[static_cast<std::size_t>(element.group)];
      for (std::size_t i = 0; i < sides; ++i) {
        const auto a = element.nodes[i], b = element.nodes[(i + 1) % n];
        const Vec3 side = places[b] - places[a];
        const double stretch = side.dot(field.displacement[b] - field.displacement[a]) / side.squaredNorm();
        most = std::max(most, std::abs(stretch - free));
      }
    }
  };
  const auto of_lines = [](const model::Group& g) { return g.thermal_expansion; };
  note(model_.cables, of_lines);
  note(model_.beams, of_lines);
  note(model_.membranes, [](const model::Group& g) { return g.membrane.thermal_expansion; });
  note(model_.shells, [](const model::Group& g) { return g.shell.thermal_expansion; });
  return largest;
}

}  // namespace tautline::assembly
