// The kernels as a table of functions, one table per instruction set, the best chosen when the core loads.
#pragma once

#include "chain.hpp"

namespace plantar {

struct Kernels {
  const char* name;
  void (*chain)(const Chain&, const Attitude&, std::size_t begin, std::size_t end, double* const* out);
};

// The tables that this build holds and this processor can run, best first; null ends the list.
const Kernels* const* runnable_kernels();

}  // namespace plantar
