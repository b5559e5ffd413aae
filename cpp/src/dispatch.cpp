// Which of the built instruction sets this processor runs.
#include <array>

#include "kernels.hpp"

namespace plantar {

namespace baseline {
extern const Kernels kernels;
}
#ifdef PLANTAR_X86_64
namespace x86_64_v3 {
extern const Kernels kernels;
}
namespace x86_64_v4 {
extern const Kernels kernels;
}
#endif

namespace {

std::array<const Kernels*, 4> found_kernels() {
  std::array<const Kernels*, 4> found{};
  int n = 0;
#ifdef PLANTAR_X86_64
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd");
  if (v4) found[n++] = &x86_64_v4::kernels;
  if (v3) found[n++] = &x86_64_v3::kernels;
#endif
  found[n] = &baseline::kernels;
  return found;
}

}  // namespace

const Kernels* const* runnable_kernels() {
  // Initialised once, under the language's own lock, however many threads ask first.
  static const std::array<const Kernels*, 4> found = found_kernels();
  return found.data();
}

}  // namespace plantar
