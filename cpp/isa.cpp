// Built once per instruction set, with its name, its lanes and its compiler flags set by CMakeLists.txt.
#include "chain_kernel.hpp"
#include "kernels.hpp"

#define PLANTAR_STRING_(x) #x
#define PLANTAR_STRING(x) PLANTAR_STRING_(x)

namespace plantar::PLANTAR_ISA {

extern const Kernels kernels;
const Kernels kernels = {PLANTAR_STRING(PLANTAR_ISA), chain};

}  // namespace plantar::PLANTAR_ISA
