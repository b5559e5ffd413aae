// Arrays as the kernels see them: bare pointers, no ownership, nothing that is compiled twice.
#pragma once

#include <cstddef>

namespace plantar {

// One column of samples; consecutive samples stand `stride` doubles apart. A null column reads as zero.
struct Column {
  const double* data = nullptr;
  std::ptrdiff_t stride = 0;
};

// A frame fixed in another: rotation (row-major) and origin.
struct Frame {
  double rotation[9];
  double origin[3];
};

}  // namespace plantar
