#pragma once
/// @file
/// How far the cloth, or a net without one, is from the paraboloid. Source: Belov (2021),
/// eqs 3.1-3.3, 3.12, 3.13; Ruze (1966). Theory: docs/theory/surface_error.md

#include <array>
#include <tautline/core/types.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <vector>

namespace tautline::reflector {

/// What is measured: a triangulated surface and the net's own nodes, in current positions.
struct SurfaceSample {
  Points positions;                           ///< all model nodes, current [m]
  std::vector<int> surface_nodes;             ///< nodes of the cloth, or of what is the surface without one
  std::vector<std::array<int, 3>> triangles;  ///< cloth facets
  std::vector<std::array<int, 2>> lines;      ///< without a cloth: the straight parts that are the surface
  std::vector<int> net_nodes;                 ///< nodes of the net
  double radius = 0;     ///< evaluate inside this radius about the z axis [m]; 0 or NaN: everything
  double frequency = 0;  ///< [Hz]; 0: no gain loss
};

struct SurfaceError {
  double rms = 0;           ///< about the mean shift, unweighted over nodes (eq. 3.13) [m]
  double mean_shift = 0;    ///< M of eq. 3.13 [m]
  double rms_direct = 0;    ///< without shift, unweighted over nodes [m]
  double rms_best_fit = 0;  ///< after the best six rigid motions and focal length, area-weighted, along z [m]
  double best_fit_focal_length = 0;  ///< [m]
  bool best_fit_converged = true;    ///< else there are better ones
  double rms_area_weighted = 0;  ///< about its area-weighted mean (eq. 3.1), integrated over the facets, or
                                 ///< by length over the lines [m]
  double rms_area_weighted_direct = 0;  ///< the same without shift [m]
  double rms_nodes = 0;                 ///< net nodes only, about their mean [m]
  double rms_half_path = 0;             ///< half path-length error, area-weighted about its mean [m]
  double radius = 0;                    ///< [m]; 0 if everything was measured
  int samples = 0;                      ///< number of nodes in `rms`
  double frequency = 0;                 ///< [Hz]
  double gain_loss_db = 0;              ///< 10 log10 exp(-(4 pi rms/lambda)^2), eq. 3.3
  double gain_loss_half_path_db = 0;    ///< the same with rms_half_path
};

/// Deviation along z of a point from the surface, z - z_par(x, y) (eq. 3.12) [m].
double deviation(const Paraboloid& surface, const Vec3& point);

/// All measures. @throws ModelError if nothing lies inside the radius.
SurfaceError measure_surface(const Paraboloid& surface, const SurfaceSample& sample);

}  // namespace tautline::reflector
