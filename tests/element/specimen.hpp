#pragma once
/// @file
/// What the ladder wants to know of an element: an adapter of it in one state. Each element has its own
/// file specimens_<element>.cpp.

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <limits>
#include <new>
#include <ostream>
#include <string>
#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>
#include <type_traits>
#include <vector>

namespace tautline::element {

/// Motion of the nodes: displacements, and for elements with spins the rotations.
struct Motion {
  MatX u;  // 3 x n
  std::vector<Mat3> rotation;
};

struct Answer {
  double energy;
  VecX force;
  MatX tangent;
};

/// Adapter of one element in one state.
struct Specimen {
  std::string name;
  bool has_spins = false;
  MatX x_ref;  // 3 x n
  Motion motion;
  /// Evaluates with given nodes; `order` renumbers them (the physical element stays the same).
  std::function<Answer(const Motion&, const std::vector<int>& order, Want)> evaluate;
  Vec3 field_force = Vec3::Zero();  ///< of an outside field, such as weight, on the whole element [N]
  std::function<Specimen(const Mat3&)> in_turned_field =
      nullptr;                    ///< the same where that field is turned; or none
  bool may_reverse_nodes = true;  ///< no node is first by nature

  int n_nodes() const { return static_cast<int>(x_ref.cols()); }
  int n_dofs() const { return n_nodes() * (has_spins ? 6 : 3); }
  std::vector<int> natural_order() const {
    std::vector<int> order(n_nodes());
    for (int i = 0; i < n_nodes(); ++i) order[i] = i;
    return order;
  }
  Answer at(const Motion& m, Want want = Want::force) const { return evaluate(m, natural_order(), want); }
  Answer here(Want want = Want::tangent) const { return at(motion, want); }
};

inline void PrintTo(const Specimen& specimen, std::ostream* out) {
  *out << specimen.name;
}

inline Mat3 turn(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

/// Adds displacements and spatial spins, R -> exp(skew(w)) R.
inline Motion moved(const Specimen& specimen, const VecX& step) {
  Motion m = specimen.motion;
  const int stride = specimen.has_spins ? 6 : 3;
  for (int i = 0; i < specimen.n_nodes(); ++i) {
    m.u.col(i) += step.segment<3>(stride * i);
    if (specimen.has_spins) m.rotation[i] = turn(step.segment<3>(stride * i + 3)) * m.rotation[i];
  }
  return m;
}

/// The whole element rotated by Q about the origin, then translated.
inline Motion moved_rigidly(const Specimen& specimen, const Mat3& Q, const Vec3& translation) {
  Motion m = specimen.motion;
  m.u = (Q * (specimen.x_ref + m.u) - specimen.x_ref).colwise() + translation;
  for (Mat3& R : m.rotation) R = Q * R;
  return m;
}

/// Runs a kernel into memory full of NaN, so that whatever it leaves unwritten shows.
template <class Response, class Kernel>
Response evaluated_over_nan(const Kernel& kernel) {
  static_assert(std::is_trivially_destructible_v<Response>);
  alignas(Response) std::array<double, (sizeof(Response) + 7) / 8> memory;
  memory.fill(std::numeric_limits<double>::quiet_NaN());
  return *::new (static_cast<void*>(memory.data())) Response(kernel());
}

template <class Response>
Answer answer_of(const Response& response, Want want) {
  return {response.energy, response.force, want == Want::tangent ? MatX(response.tangent) : MatX()};
}

template <int N>
Mat<3, N> reordered(const MatX& columns, const std::vector<int>& order) {
  Mat<3, N> result;
  for (int i = 0; i < N; ++i) result.col(i) = columns.col(order[i]);
  return result;
}

template <int N>
Vec<3 * N> flat(const Mat<3, N>& columns) {
  return Eigen::Map<const Vec<3 * N>>(columns.data());
}

// One function for each file specimens_<element>.cpp.
std::vector<Specimen> cable_specimens();
std::vector<Specimen> membrane_specimens();
std::vector<Specimen> beam_specimens();
std::vector<Specimen> catenary_specimens();
std::vector<Specimen> spring_specimens();
std::vector<Specimen> shell_specimens();

}  // namespace tautline::element
