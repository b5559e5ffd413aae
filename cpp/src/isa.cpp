// Built once per instruction set, with its name, its lanes and its compiler flags set by CMakeLists.txt.
#include "chain_kernel.hpp"
#include "frame_kernel.hpp"
#include "gram_kernel.hpp"
#include "inverse_dynamics_kernel.hpp"
#include "kernels.hpp"
#include "low_pass_kernel.hpp"
#include "qr_kernel.hpp"
#include "sole_load_kernel.hpp"

#define PLANTAR_STRING_(x) #x
#define PLANTAR_STRING(x) PLANTAR_STRING_(x)

namespace plantar::PLANTAR_ISA {

extern const Kernels kernels;
const Kernels kernels = {PLANTAR_STRING(PLANTAR_ISA),
                         sizeof(LinkState) + sizeof(Wrench),
                         qr_work,
                         chain,
                         chain_bundle,
                         sole_load,
                         regressor,
                         inverse_dynamics,
                         base_wrenches,
                         root_motion,
                         base_transfer,
                         qr_update,
                         gram_update,
                         cholesky,
                         LANES,
                         low_pass};

}  // namespace plantar::PLANTAR_ISA
