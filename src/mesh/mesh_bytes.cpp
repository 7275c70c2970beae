#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "mesh/mesh_bytes.hpp"

namespace tautline::mesh {

namespace {

template <class Value>
void put(std::string& bytes, const Value& value) {
  static_assert(std::is_trivially_copyable_v<Value>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const std::string& text) {
  put(bytes, text.size());
  bytes += text;
}

template <class Cell>
void put(std::string& bytes, const std::vector<Cell>& cells) {
  put(bytes, cells.size());
  for (const auto& cell : cells) put(bytes, cell);
}

class Taking {
 public:
  explicit Taking(const std::string& bytes) : bytes_(bytes) {}

  template <class Value>
  void take(Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    std::memcpy(&value, next(sizeof value), sizeof value);
  }
  void take(std::string& text) {
    std::size_t size = 0;
    take(size);
    text.assign(next(size), size);
  }
  template <class Cell>
  void take(std::vector<Cell>& cells) {
    std::size_t size = 0;
    take(size);
    if (size > bytes_.size() / sizeof(Cell)) throw std::runtime_error("its mesh was cut off");
    cells.resize(size);
    for (auto& cell : cells) take(cell);
  }
  void end() const {
    if (at_ != bytes_.size()) throw std::runtime_error("its mesh has too many bytes");
  }

 private:
  const char* next(std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("its mesh was cut off");
    const char* here = bytes_.data() + at_;
    at_ += size;
    return here;
  }

  const std::string& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::string to_bytes(const Reading& reading) {
  std::string bytes;
  put(bytes, reading.outcome);
  put(bytes, reading.reason);
  put(bytes, reading.mesh.nodes.size());
  for (const auto& node : reading.mesh.nodes)
    for (int i = 0; i < 3; ++i) put(bytes, node[i]);
  put(bytes, reading.mesh.groups.size());
  for (const auto& [name, group] : reading.mesh.groups) {
    put(bytes, name);
    put(bytes, group.points);
    put(bytes, group.lines);
    put(bytes, group.triangles);
    put(bytes, group.quadrilaterals);
  }
  return bytes;
}

Reading from_bytes(const std::string& bytes) {
  Reading reading;
  Taking from(bytes);
  from.take(reading.outcome);
  from.take(reading.reason);
  std::vector<std::array<double, 3>> nodes;
  from.take(nodes);
  for (const auto& [x, y, z] : nodes) reading.mesh.nodes.emplace_back(x, y, z);
  std::size_t n_groups = 0;
  from.take(n_groups);
  for (std::size_t i = 0; i < n_groups; ++i) {
    std::string name;
    from.take(name);
    auto& group = reading.mesh.groups[name];
    from.take(group.points);
    from.take(group.lines);
    from.take(group.triangles);
    from.take(group.quadrilaterals);
  }
  from.end();
  return reading;
}

}  // namespace tautline::mesh
