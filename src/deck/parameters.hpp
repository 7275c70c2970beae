#pragma once
/// @file
/// Changes to the tree before it is read: values from the command line, and `${name}` put in.

#include <deck/node.hpp>
#include <deck/source.hpp>
#include <string>
#include <vector>

namespace tautline::deck {

/// Applies "path.to.key=value" to the tree. Values replaced or added carry the override as their place.
void apply_overrides(Node& root, const std::vector<std::string>& overrides, Complaints& complaints);

/// Puts the values of the block `parameters` wherever "${name}" stands.
void substitute_parameters(Node& root, const Source& source, Complaints& complaints);

}  // namespace tautline::deck
