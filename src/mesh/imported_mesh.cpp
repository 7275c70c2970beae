#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string_view>
#include <tautline/core/error.hpp>
#include <tautline/core/plugin.hpp>
#include <tautline/core/text.hpp>
#include <tautline/mesh/imported_mesh.hpp>

#include "mesh/gmsh/plugin.hpp"

namespace tautline::mesh {

namespace {

/// gmsh itself takes a missing file for an empty one, and runs as a script whatever is no mesh.
void require_mesh_file(const std::string& path) {
  constexpr std::string_view opening = "$MeshFormat";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw LibraryError(fmt::format("cannot read the mesh {}: there is no such file", path));
  std::string begins(opening.size(), ' ');
  std::ifstream(path, std::ios::binary).read(begins.data(), static_cast<std::streamsize>(begins.size()));
  if (begins != opening)
    throw ModelError(fmt::format(
        "{} is not a gmsh mesh: a mesh file begins with \"{}\" (versions 2.2 and 4.1, text or binary). A "
        "script (.geo) is meshed by gmsh first: gmsh -2 drawing.geo -o mesh.msh",
        path, opening));
}

}  // namespace

ImportedMesh import_gmsh(const std::string& path) {
  using gmsh_plugin::Outcome;
  require_mesh_file(path);
  static const auto read = reinterpret_cast<decltype(&tautline_read_gmsh)>(
      load_plugin_symbol(gmsh_plugin::file, gmsh_plugin::symbol, gmsh_plugin::remedy));
  ImportedMesh mesh;
  std::string reason;
  const Outcome outcome = read(path.c_str(), &mesh, &reason);
  if (outcome == Outcome::unreadable)
    throw LibraryError(fmt::format("gmsh cannot read the mesh {}: {}", path, reason));
  if (outcome == Outcome::unsuitable) throw ModelError(fmt::format("the mesh {} {}", path, reason));
  for (const auto& [name, group] : mesh.groups)
    if (first_bad_byte(name) != std::string::npos)
      throw ModelError(
          fmt::format("the mesh {} has a physical group whose name is no plain text in UTF-8", path));
  return mesh;
}

}  // namespace tautline::mesh
