// Arrays as the kernels see them: bare pointers, no ownership, nothing that is compiled twice.
#pragma once

#include <cstddef>

#include "plantar/frame.hpp"

namespace plantar {

// One column of samples; consecutive samples stand `stride` doubles apart. A null column reads as zero.
struct Column {
  const double* data = nullptr;
  std::ptrdiff_t stride = 0;
};

}  // namespace plantar
