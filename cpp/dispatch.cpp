// Which of the built instruction sets this processor runs.
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

const Kernels* const* runnable_kernels() {
  static const Kernels* found[4] = {};
  if (found[0] == nullptr) {
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
  }
  return found;
}

}  // namespace plantar
