#pragma once
/// @file
/// A mesh read from a file: nodes and cells under the names of its physical groups.

#include <array>
#include <map>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>

namespace tautline::mesh {

/// Cells of one physical group; usually of one kind.
struct CellGroup {
  std::vector<int> points;  ///< node indices of point cells, and of nothing else
  std::vector<std::array<int, 2>> lines;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 4>> quadrilaterals;
};

struct ImportedMesh {
  Points nodes;                             ///< nodes used by some physical group, in file order [m]
  std::map<std::string, CellGroup> groups;  ///< by physical name
};

/// @brief Reads a gmsh .msh file (any version gmsh reads). gmsh is loaded on first use from a plugin
/// and reads in a child process, which a damaged file may end.
/// @throws LibraryError if gmsh cannot be loaded or read the file; ModelError if the file has no named
/// physical group, or cells of a kind or order the program has no element for (names them)
ImportedMesh import_gmsh(const std::string& path);

}  // namespace tautline::mesh
