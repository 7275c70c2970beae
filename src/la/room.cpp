#include "la/room.hpp"

#include <cstddef>

#include <dlfcn.h>
#include <sys/mman.h>

#include <tautline/core/out_of_memory.hpp>

namespace tautline::la {

void demand_room(int megabytes) {
  const std::size_t bytes = static_cast<std::size_t>(megabytes) << 20U;
  void* place = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw OutOfMemory();
  munmap(place, bytes);
}

void hold_blas_buffer() {
  demand_room(150);
  using Trsm = void (*)(const char*, const char*, const char*, const char*, const int*, const int*,
                        const double*, const double*, const int*, double*, const int*);
  const auto trsm = reinterpret_cast<Trsm>(dlsym(RTLD_DEFAULT, "dtrsm_"));
  if (trsm == nullptr) return;
  const int one = 1;
  const double scale = 1, factor = 2;
  double value = 4;
  trsm("L", "L", "N", "N", &one, &one, &scale, &factor, &one, &value, &one);
}

}  // namespace tautline::la
