#pragma once
/// @file
/// Loads that have nothing to act on.

#include <string>
#include <vector>

#include <tautline/model/model.hpp>

namespace tautline::model::detail {

/// What keeps loads of the model from acting in full, a sentence for each fault with the load's place in the
/// deck.
std::vector<std::string> load_faults(const Model& model);

}  // namespace tautline::model::detail
