#pragma once

namespace tautline::formfinding {

struct ToleranceOptions {
  int n_samples = 1000;  ///< random nets, by the linear sensitivities; 0: the exact moments only
  int seed = 1;
};

}  // namespace tautline::formfinding
