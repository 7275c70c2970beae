#pragma once
/// @file
/// Declares the block of one kind of step.

#include <deck/builder.hpp>
#include <string>
#include <tautline/steps/step_options.hpp>

namespace tautline::deck {

/// A block with the key `name`, which every step has.
template <class Options>
BlockBuilder<steps::Step, Options> step_builder(const std::string& kind, const std::string& sentence) {
  BlockBuilder<steps::Step, Options> b("steps." + kind, kind, sentence);
  b.key("name", &steps::Step::name)
      .by_default("the kind, with a number where it repeats")
      .says("Name for results and --set; no two steps share one.");
  return b;
}

}  // namespace tautline::deck
