#pragma once

namespace tautline::formfinding {

struct ElasticOptions {
  double tolerance = 1e-10;  ///< largest force out of balance relative to the largest tension or load [-]
  int max_iterations = 1000;
};

}  // namespace tautline::formfinding
