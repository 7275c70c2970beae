/// @file
/// libFuzzer: any bytes are a mesh that another process read, or told to be none. gmsh's own reader is tried
/// by fuzz_inputs --what meshes.

#include <cstdint>
#include <stdexcept>

#include "mesh/mesh_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tautline::mesh::from_bytes({reinterpret_cast<const char*>(data), size});
  } catch (const std::runtime_error&) {
  }
  return 0;
}
