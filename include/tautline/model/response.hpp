#pragma once
/// @file
/// What the elements carry in a state, one entry for each element in model order.

#include <map>
#include <string>
#include <vector>

#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::model {

struct CableResult {
  double length = 0;   ///< current [m]
  double tension = 0;  ///< [N]
  bool slack = false;
};

struct MembraneResult {
  Vec<2> principal_cauchy{0, 0};  ///< [N/m]
};

struct Response {
  std::vector<CableResult> cables;
  std::vector<element::BeamForces> beams;
  std::vector<Mat3> beam_frames;  ///< current local axes
  std::vector<MembraneResult> membranes;
};

/// Evaluates every element (serial; a few milliseconds for 10^5 elements).
Response evaluate_response(const Model& model, const State& state);

/// Figures of one group. A cable split in segments counts once for each segment.
struct GroupSummary {
  ElementKind kind = ElementKind::cable;
  int count = 0, slack = 0;
  double tension_min = 0, tension_max = 0, tension_mean = 0;
  double tension_rms_from_target = 0;  ///< Belov eq. 4.13; target = Group::target_tension
  bool has_target = false;
  double axial_min = 0, axial_max = 0, moment_max = 0;  ///< beams
  double principal_min = 0, principal_max = 0;          ///< membranes [N/m]
};

std::map<std::string, GroupSummary> summarise_groups(const Model& model, const Response& response);

}  // namespace tautline::model
