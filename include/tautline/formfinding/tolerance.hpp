#pragma once
/// @file
/// What errors of unstressed lengths do to an elastic net: sensitivities and statistics.

#include <tautline/formfinding/elastic_net.hpp>
#include <tautline/formfinding/tolerance_options.hpp>
#include <vector>

namespace tautline::formfinding {

/// Change of a net in equilibrium, linear in the errors of the unstressed lengths.
struct LengthEffect {
  Points displacement;  ///< of all nodes [m]
  VecX tension;         ///< change of every branch [N]
};

/// @brief Linear answer of the net to errors of its unstressed lengths [m], one for each branch.
/// @pre net.net.nodes are in equilibrium
/// @throws ModelError if the net makes no sense, or its tangent is not positive definite
LengthEffect find_length_effect(const ElasticNet& net, const VecX& error);

/// Which displacement counts as deviation, and of which nodes.
struct Deviation1d {
  int node = -1;
  Vec3 direction = Vec3::UnitZ();  ///< unit vector: axis of the reflector, or normal of its surface
};

struct ToleranceResult {
  VecX tension_sigma;       ///< standard deviation of every tension [N]
  Points position_sigma;    ///< standard deviation of every node in x, y, z [m]
  double rms_expected = 0;  ///< square root of the mean of rms^2 over all nets [m]
  std::vector<double> rms;  ///< of the random nets, in increasing order [m]
  /// The rms that a part p of all nets does not exceed [m]. @pre n_samples > 0
  double rms_quantile(double p) const;
};

/// @brief Statistics of tensions, positions and the rms of deviations for independent, normally distributed
/// errors of the unstressed lengths.
///
/// Standard deviations are exact for the linear net, one solve for each branch with an error; the
/// distribution of the rms is sampled.
/// @param[in] sigma  standard deviation of each unstressed length [m]; zero: exact
/// @throws ModelError as find_length_effect, or if no length has an error
ToleranceResult analyse_tolerance(const ElasticNet& net, const VecX& sigma,
                                  const std::vector<Deviation1d>& deviations,
                                  const ToleranceOptions& options = {});

/// Length to cut a cable to at the reference temperature [m]: unstressed at `temperature_rise` above it.
/// L0 = L EA / (EA + T) / (1 + expansion x rise)
double cut_length(double length, double tension, double axial_stiffness, double expansion = 0,
                  double temperature_rise = 0);

}  // namespace tautline::formfinding
