#pragma once

namespace tautline::formfinding {

/// How the fictitious motion comes to rest.
enum class Damping {
  kinetic,  ///< stopped at each peak of the kinetic energy (1.26-1.29)
  viscous   ///< damped critically (1.19-1.21), the frequency estimated by a run without damping (1.25)
};

struct DynamicRelaxationOptions {
  Damping damping = Damping::kinetic;
  double damping_ratio = 1.0;  ///< viscous: part of the estimated critical damping [-]
  double mass_factor = 1.1;    ///< masses relative to the smallest that are stable, K/2 (1.24) [-]
  double tolerance = 1e-9;     ///< largest force out of balance relative to the largest tension or load [-]
  int max_iterations = 100000;
};

}  // namespace tautline::formfinding
