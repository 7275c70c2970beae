#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string_view>
#include <tautline/core/error.hpp>
#include <tautline/core/plugin.hpp>
#include <tautline/core/text.hpp>
#include <tautline/mesh/imported_mesh.hpp>

#include "mesh/child.hpp"
#include "mesh/gmsh/plugin.hpp"
#include "mesh/mesh_bytes.hpp"
#include "mesh/msh_counts.hpp"

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
  if (const std::string fault = fault_of_counts(path); !fault.empty())
    throw ModelError(fmt::format("the mesh {} is damaged: it {}", path, fault));
}

/// Far above what gmsh needs for a mesh of that size.
ChildLimits limits_for(std::size_t file_bytes) {
  constexpr std::size_t megabyte = 1U << 20U;
  return {1024 * megabyte + 100 * file_bytes, static_cast<int>(8 + 5 * (file_bytes / megabyte))};
}

/// gmsh's reader trusts the numbers in a file; a damaged one may be its end, but not that of this program.
Reading read_in_child(const std::string& path) {
  static const auto read = reinterpret_cast<decltype(&tautline_read_gmsh)>(
      load_plugin_symbol(gmsh_plugin::file, gmsh_plugin::symbol, gmsh_plugin::remedy));
  const auto work = [&path] {
    Reading reading;
    reading.outcome = read(path.c_str(), &reading.mesh, &reading.reason);
    return to_bytes(reading);
  };
  Reading failed;
  const std::string bytes = in_child(work, limits_for(std::filesystem::file_size(path)), failed.reason);
  if (!failed.reason.empty()) {
    failed.reason += "; the file is damaged, or no mesh of version 2.2 or 4.1";
    return failed;
  }
  try {
    return from_bytes(bytes);
  } catch (const std::exception& error) {
    failed.reason = error.what();
    return failed;
  }
}

void require_sound(const ImportedMesh& mesh, const std::string& path) {
  for (const auto& node : mesh.nodes)
    if (!node.allFinite())
      throw ModelError(fmt::format("the mesh {} has a node whose coordinates are no finite numbers", path));
  for (const auto& [name, group] : mesh.groups)
    if (first_bad_byte(name) != std::string::npos)
      throw ModelError(
          fmt::format("the mesh {} has a physical group whose name is no plain text in UTF-8", path));
}

}  // namespace

ImportedMesh import_gmsh(const std::string& path) {
  using gmsh_plugin::Outcome;
  require_mesh_file(path);
  Reading reading = read_in_child(path);
  if (reading.outcome == Outcome::unreadable)
    throw LibraryError(fmt::format("gmsh cannot read the mesh {}: {}", path, reading.reason));
  if (reading.outcome == Outcome::unsuitable)
    throw ModelError(fmt::format("the mesh {} {}", path, reading.reason));
  require_sound(reading.mesh, path);
  return std::move(reading.mesh);
}

}  // namespace tautline::mesh
