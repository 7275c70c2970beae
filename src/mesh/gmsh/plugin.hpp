#pragma once
/// @file
/// What the gmsh plugin offers to the program. Both are built by the same compiler from the same headers, so
/// the structs cross as they are; exceptions do not.

#include <string>
#include <tautline/mesh/imported_mesh.hpp>

namespace tautline::mesh::gmsh_plugin {

enum class Outcome {
  read,
  unreadable,  ///< gmsh failed: a LibraryError for the user
  unsuitable   ///< gmsh read it, but it is no mesh for this program: a ModelError
};

constexpr auto file = "tautline_gmsh.so";
constexpr auto symbol = "tautline_read_gmsh";
constexpr auto remedy =
    "meshes are read by gmsh: build with TAUTLINE_WITH_GMSH=ON (apt-get install libgmsh-dev) or describe the "
    "structure inline";

}  // namespace tautline::mesh::gmsh_plugin

extern "C" {

/// Fills `mesh`; or leaves it and writes the reason to `reason`.
tautline::mesh::gmsh_plugin::Outcome tautline_read_gmsh(const char* path, tautline::mesh::ImportedMesh* mesh,
                                                        std::string* reason);
}
