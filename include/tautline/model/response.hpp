#pragma once
/// @file
/// What the elements carry in a state, one entry for each element in model order.

#include <map>
#include <string>
#include <vector>

#include <tautline/model/model.hpp>
#include <tautline/model/rounding.hpp>
#include <tautline/model/state.hpp>

namespace tautline::model {

struct CableResult {
  double length = 0;   ///< current [m]
  double tension = 0;  ///< [N]; of a bar negative in compression; of a catenary at its higher-loaded end
  bool slack = false;
};

struct MembraneResult {
  Vec<2> principal_cauchy{0, 0};  ///< [N/m]
  element::MembraneState state = element::MembraneState::taut;
};

struct SpringResult {
  Vec3 force{0, 0, 0}, moment{0, 0, 0};  ///< in the axes that turn with the first node [N], [N m]
};

struct Response {
  std::vector<CableResult> cables;
  std::vector<element::BeamForces> beams;
  std::vector<Mat3> beam_frames;  ///< current local axes
  std::vector<MembraneResult> membranes;
  std::vector<element::ShellForces> shells;
  std::vector<SpringResult> springs;
};

/// Evaluates every element (serial; a few milliseconds for 10^5 elements).
Response evaluate_response(const Model& model, const State& state);

/// Whether it resists pull alone: a cable or a catenary, no bar.
bool only_pulls(const Model& model, const Cable& cable);

/// Whether it only pulls and does not pull, or by no more than a solve may leave where the last load has gone
/// (a strain of 1e-9).
bool is_slack(const Model& model, const State& state, const Cable& cable);

/// Principal values of a symmetric tensor (T11, T22, T12), larger first.
Vec<2> principal_values(const Vec3& tensor);

/// Figures of one group. A cable split in segments counts once for each segment.
struct GroupSummary {
  ElementKind kind = ElementKind::cable;
  int count = 0, slack = 0;  ///< slack: cables, and membranes without any tension
  int wrinkled = 0;          ///< membranes
  double tension_min = 0, tension_max = 0, tension_mean = 0;
  double tension_rms_from_target = 0;  ///< Belov eq. 4.13; target = Group::target_tension
  bool has_target = false;
  double axial_min = 0, axial_max = 0;          ///< beams and bars [N]
  double moment_max = 0;                        ///< beams, springs [N m]; shells [N]
  double principal_min = 0, principal_max = 0;  ///< membranes and shells [N/m]
  double force_max = 0;                         ///< springs [N]
  Rounding rounding;                            ///< below which forces and moments mean nothing
};

std::map<std::string, GroupSummary> summarise_groups(const Model& model, const State& state,
                                                     const Response& response);

}  // namespace tautline::model
