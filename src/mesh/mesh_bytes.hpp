#pragma once
/// @file
/// A mesh as bytes, for the way from one process to another on the same machine.

#include <string>
#include <tautline/mesh/imported_mesh.hpp>

#include "mesh/gmsh/plugin.hpp"

namespace tautline::mesh {

struct Reading {
  gmsh_plugin::Outcome outcome = gmsh_plugin::Outcome::unreadable;
  std::string reason;
  ImportedMesh mesh;
};

std::string to_bytes(const Reading& reading);
/// @throws std::runtime_error if the bytes are no reading
Reading from_bytes(const std::string& bytes);

}  // namespace tautline::mesh
