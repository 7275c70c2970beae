#pragma once
/// @file
/// What differs between the two ends of a beam.

#include <tautline/model/response.hpp>

namespace tautline::model {

/// Axial force and shear of the first end of a beam; `response.beams` has those of the second. Between them
/// is the load along the beam.
Vec3 first_end_force(const Model& model, const Response& response, std::size_t beam);

}  // namespace tautline::model
