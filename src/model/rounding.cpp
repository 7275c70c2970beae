#include <tautline/model/rounding.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <tautline/model/element_data.hpp>

namespace tautline::model {

namespace {

/// How large an element's forces (first row) and moments (second row) are by displacement and by rotation:
/// those on its nodes, and those that its group reports, of facets per width.
struct Stiffness {
  Mat<2> nodal = Mat<2>::Zero(), own = Mat<2>::Zero();
};

Mat<2> matrix(double force_by_displacement, double force_by_rotation, double moment_by_displacement,
              double moment_by_rotation) {
  Mat<2> m;
  m << force_by_displacement, force_by_rotation, moment_by_displacement, moment_by_rotation;
  return m;
}

Stiffness stiffness_of(const Model& model, const Cable& cable) {
  const Mat<2> k = matrix(model.axial_stiffness(cable) / model.reference_length(cable), 0, 0, 0);
  return {k, k};
}

Stiffness stiffness_of(const Model& model, const Beam& beam) {
  const auto section = beam_section(model, beam);
  const double length = (model.nodes[beam.nodes[1]] - model.nodes[beam.nodes[0]]).norm();
  const double bending = std::max(section.bending_stiffness_2, section.bending_stiffness_3) / length;
  const double axial = section.axial_stiffness / length, shear = 6 * bending / length;
  const double turning = std::max(4 * bending, section.torsion_stiffness / length);
  return {matrix(axial + 2 * shear / length, shear, shear, turning), matrix(axial, 0, shear, 4 * bending)};
}

/// Root of the area of the triangle or of the two triangles of a quadrilateral.
double width_of(const Model& model, const FacetNodes& nodes) {
  double area = 0;
  for (int k = 2; k < nodes.size(); ++k)
    area += (model.nodes[nodes[k - 1]] - model.nodes[nodes[0]])
                .cross(model.nodes[nodes[k]] - model.nodes[nodes[0]])
                .norm() /
            2;
  return std::sqrt(area);
}

Stiffness stiffness_of(const Model& model, const Membrane& membrane) {
  const auto& section = model.groups[membrane.group].membrane;
  const double k = std::max(section.tension_stiffness, section.tension_stiffness_2);
  return {matrix(k, 0, 0, 0), matrix(k / width_of(model, membrane.nodes), 0, 0, 0)};
}

Stiffness stiffness_of(const Model& model, const Shell& shell) {
  const auto& section = model.groups[shell.group].shell;
  const double width = width_of(model, shell.nodes), t = section.thickness;
  const double k = section.young_modulus * t, bending = k * t * t / 12;
  return {matrix(k, k * width, k * width, k * width * width + bending),
          matrix(k / width, k, bending / (width * width), bending / width)};
}

Stiffness stiffness_of(const Model& model, const Spring& spring) {
  const auto& properties = model.groups[spring.group].spring;
  const Mat<2> k = matrix(properties.stiffness.maxCoeff(), 0, 0, properties.rotational_stiffness.maxCoeff());
  return {k, k};
}

Stiffness stiffness_of(const Model&, const MassElement&) {
  return {};
}

template <class Element>
double largest_displacement(const State& state, const Element& element) {
  double largest = 0;
  for (const int node : element.nodes) largest = std::max(largest, state.displacement[node].norm());
  return largest;
}

/// What the rotations of an element are the last digit of: a beam's are taken relative to its axes, which
/// stand anyhow in space.
template <class Element>
double largest_rotation(const State&, const Element&) {
  return 1;
}

/// A shell's directors move by R - I.
double largest_rotation(const State& state, const Shell& shell) {
  double largest = 0;
  for (const int node : shell.nodes)
    largest = std::max(largest, (state.rotation[node] - Mat3::Identity()).cwiseAbs().maxCoeff());
  return largest;
}

/// How many last digits the strain of an element adds up: that of a line is a difference of places and
/// lengths over a length, that of a facet one of displacements.
template <class Element>
constexpr double digits_added() {
  return std::is_same_v<Element, Cable> || std::is_same_v<Element, Beam> ? 4 : 1;
}

/// Calls `visit(element, stiffness, last digits of its displacements and rotations)` for every element.
template <class Visit>
void for_each_digit(const Model& model, const State& state, const Visit& visit) {
  for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements)
      visit(element, stiffness_of(model, element),
            digits_added<std::decay_t<decltype(element)>>() * last_digit *
                Vec<2>(largest_displacement(state, element), largest_rotation(state, element)));
  });
}

/// By which forces on followers become moments on their leaders [m].
double longest_arm(const Model& model) {
  double longest = 0;
  for (const auto& link : model.links)
    longest = std::max(longest, (model.nodes[link.follower] - model.nodes[link.leader]).norm());
  return longest;
}

}  // namespace

Rounding nodal_rounding(const Model& model, const State& state) {
  Vec<2> squares = Vec<2>::Zero();
  for_each_digit(model, state, [&](const auto&, const Stiffness& k, const Vec<2>& digits) {
    squares += (k.nodal * digits).cwiseAbs2();
  });
  for (const auto& beam : model.beams) {  // the last digit of its length, as a force that its ends lie apart
    const double length = (model.nodes[beam.nodes[1]] - model.nodes[beam.nodes[0]]).norm();
    const double axial = beam_section(model, beam).axial_stiffness * digits_added<Beam>() * last_digit;
    squares[1] += std::pow(axial * length, 2);
  }
  const double force = std::sqrt(squares[0]);
  return {force, std::sqrt(squares[1]) + longest_arm(model) * force};
}

std::vector<Rounding> rounding_by_group(const Model& model, const State& state) {
  std::vector<Rounding> result(model.groups.size());
  for_each_digit(model, state, [&](const auto& element, const Stiffness& k, const Vec<2>& digits) {
    auto& group = result[static_cast<std::size_t>(element.group)];
    const Vec<2> level = k.own * digits;
    group.force = std::max(group.force, level[0]);
    group.moment = std::max(group.moment, level[1]);
  });
  return result;
}

}  // namespace tautline::model
