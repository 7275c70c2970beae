#pragma once
/// @file
/// One structure under one relation, and the smallest structure that still breaks it.

#include "relation.hpp"

namespace tautline::metamorphic {

struct Verdict {
  enum class Kind {
    holds,
    void_,      ///< the relation does not apply to the structure
    discarded,  ///< no job was done, and all ended alike
    ends_differ,
    numbers_differ
  } kind = Kind::void_;
  std::vector<Difference> differences;  ///< the largest first
  std::string ends;                     ///< how jobs ended, where not all were done
  int n_done = 0;                       ///< jobs that came to their end
  Trial trial;
  bool fails() const { return kind == Kind::ends_differ || kind == Kind::numbers_differ; }
  double worst() const { return differences.empty() ? 0 : differences.front().measure; }
};

/// Derives, runs and judges. `seed` chooses what is random in the relation.
Verdict try_relation(const Relation& relation, const Json& deck, std::uint64_t seed, Runner& runner);

/// Takes away loads, steps, elements and digits as long as the relation fails in the same way.
Json smallest(const Relation& relation, Json deck, std::uint64_t seed, Runner& runner, double seconds);

}  // namespace tautline::metamorphic
