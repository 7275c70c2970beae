#pragma once
/// @file
/// Nets that carry cloth: the pull of the cloth is a part of the balance of the nodes.

#include <tautline/formfinding/constraints.hpp>

namespace tautline::formfinding {

/// find_form for a problem with triangles. @pre checked
ConstrainedResult find_form_with_cloth(const ConstrainedNet& problem, const ConstrainedOptions& options);

}  // namespace tautline::formfinding
