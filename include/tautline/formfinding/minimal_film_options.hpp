#pragma once

namespace tautline::formfinding {

struct MinimalFilmOptions {
  double tolerance =
      1e-8;  ///< largest force out of balance relative to the largest stress x side or tension [-]
  int max_iterations = 500;
};

}  // namespace tautline::formfinding
