#include <fcntl.h>
#include <fmt/format.h>
#include <gmsh.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "mesh/gmsh/plugin.hpp"

namespace tautline::mesh::gmsh_plugin {

namespace {

/// The mesh is read but of no use to the program.
class Unsuitable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// gmsh between its start and its end, with nothing printed.
class Session {
 public:
  Session() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

/// gmsh's numbers of element types.
enum GmshType { line = 1, triangle = 2, quadrilateral = 3, point = 15 };

struct Nodes {
  std::unordered_map<std::size_t, int> index_of_tag;  ///< in file order
  Points positions;
};

Nodes read_nodes() {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters, -1, -1, false, false);
  Nodes nodes;
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (nodes.index_of_tag.emplace(tags[i], static_cast<int>(nodes.positions.size())).second)
      nodes.positions.emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  return nodes;
}

void require_supported(const std::string& group, int type) {
  if (type == line || type == triangle || type == quadrilateral || type == point) return;
  std::string name;
  int dimension = 0, order = 0, n_nodes = 0, n_primary = 0;
  std::vector<double> local;
  gmsh::model::mesh::getElementProperties(type, name, dimension, order, n_nodes, local, n_primary);
  throw Unsuitable(
      fmt::format("has cells of the kind \"{}\" (dimension {}, order {}) in its physical group \"{}\"; there "
                  "are elements for points, lines, "
                  "triangles and quadrilaterals of order 1 only{}",
                  name, dimension, order, group, order > 1 ? ": set Mesh.ElementOrder = 1 in gmsh" : ""));
}

void add_cells(const Nodes& nodes, int type, const std::vector<std::size_t>& tags, CellGroup& group) {
  const auto at = [&](std::size_t i) {
    const auto found = nodes.index_of_tag.find(tags[i]);
    if (found == nodes.index_of_tag.end())
      throw Unsuitable(fmt::format("has a cell with node {}, which it does not have", tags[i]));
    return found->second;
  };
  if (type == point)
    for (std::size_t i = 0; i < tags.size(); ++i) group.points.push_back(at(i));
  else if (type == line)
    for (std::size_t i = 0; i + 1 < tags.size(); i += 2) group.lines.push_back({at(i), at(i + 1)});
  else if (type == triangle)
    for (std::size_t i = 0; i + 2 < tags.size(); i += 3)
      group.triangles.push_back({at(i), at(i + 1), at(i + 2)});
  else
    for (std::size_t i = 0; i + 3 < tags.size(); i += 4)
      group.quadrilaterals.push_back({at(i), at(i + 1), at(i + 2), at(i + 3)});
}

std::map<std::string, CellGroup> read_groups(const Nodes& nodes) {
  std::map<std::string, CellGroup> groups;
  gmsh::vectorpair physical;
  gmsh::model::getPhysicalGroups(physical);
  for (const auto& [dimension, tag] : physical) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    if (name.empty()) continue;
    std::vector<int> entities;
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, entities);
    for (const int entity : entities) {
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> cells, cell_nodes;
      gmsh::model::mesh::getElements(types, cells, cell_nodes, dimension, entity);
      for (std::size_t k = 0; k < types.size(); ++k) {
        require_supported(name, types[k]);
        add_cells(nodes, types[k], cell_nodes[k], groups[name]);
      }
    }
  }
  if (groups.empty())
    throw Unsuitable(
        physical.empty()
            ? "has no physical group: name its points, lines and surfaces in gmsh, e.g. Physical "
              "Surface(\"cloth\") = {1};"
            : "has no named physical group with cells: name its groups in gmsh and mesh it, e.g. gmsh -2");
  return groups;
}

/// Applies `action` to every node index of the groups.
template <class Action>
void for_each_node(std::map<std::string, CellGroup>& groups, const Action& action) {
  for (auto& [name, group] : groups) {
    for (int& node : group.points) action(node);
    for (auto& cell : group.lines)
      for (int& node : cell) action(node);
    for (auto& cell : group.triangles)
      for (int& node : cell) action(node);
    for (auto& cell : group.quadrilaterals)
      for (int& node : cell) action(node);
  }
}

/// Keeps the nodes that some group uses, in their order.
ImportedMesh compact(const Points& positions, std::map<std::string, CellGroup> groups) {
  std::vector<int> number(positions.size(), -1);
  for_each_node(groups, [&](int& node) { number[node] = 0; });
  ImportedMesh mesh;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (number[i] == 0) {
      number[i] = static_cast<int>(mesh.nodes.size());
      mesh.nodes.push_back(positions[i]);
    }
  for_each_node(groups, [&](int& node) { node = number[node]; });
  mesh.groups = std::move(groups);
  return mesh;
}

/// A file under a name without suffix and without neighbours. gmsh chooses its reader by the suffix, and runs
/// as a script what lies beside a file as <name>.opt.
class NamelessFile {
 public:
  explicit NamelessFile(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw std::runtime_error(std::strerror(errno));
    std::string begins(opening.size(), ' ');
    const auto n = ::pread(descriptor_, begins.data(), begins.size(), 0);
    if (n != static_cast<ssize_t>(begins.size()) || begins != opening) {
      ::close(descriptor_);
      throw std::runtime_error(fmt::format("it does not begin with {}", opening));
    }
  }
  ~NamelessFile() { ::close(descriptor_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  std::string name() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  static constexpr std::string_view opening = "$MeshFormat";
  int descriptor_;
};

ImportedMesh read(const std::string& path) {
  const NamelessFile file(path);
  const Session session;
  try {
    gmsh::open(file.name());
  } catch (const std::string& message) {  // may hold a name that nobody knows
    if (message.find(file.name()) != std::string::npos)
      throw std::runtime_error("something in it is no number, or it ends too early");
    throw;
  }
  const Nodes nodes = read_nodes();
  return compact(nodes.positions, read_groups(nodes));
}

}  // namespace

}  // namespace tautline::mesh::gmsh_plugin

extern "C" __attribute__((visibility("default"))) tautline::mesh::gmsh_plugin::Outcome tautline_read_gmsh(
    const char* path, tautline::mesh::ImportedMesh* mesh, std::string* reason) {
  using namespace tautline::mesh::gmsh_plugin;
  try {
    *mesh = read(path);
    return Outcome::read;
  } catch (const Unsuitable& error) {
    *reason = error.what();
    return Outcome::unsuitable;
  } catch (const std::string& message) {  // what gmsh throws
    *reason = message;
  } catch (const std::exception& error) {
    *reason = error.what();
  } catch (...) {
    *reason = "gmsh failed without a reason";
  }
  return Outcome::unreadable;
}
