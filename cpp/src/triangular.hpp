// The inverse of a small upper triangle.
#pragma once

#include <cstddef>

namespace plantar {

// inverse = upper⁻¹, both row-major n x n, from the last row upwards; no entry of the diagonal may be zero.
inline void invert_upper(const double* upper, double* inverse, std::size_t n) {
  for (std::size_t i = n; i-- > 0;) {
    double* row = inverse + i * n;
    for (std::size_t k = 0; k < n; ++k) row[k] = 0.0;
    for (std::size_t j = i + 1; j < n; ++j) {
      const double share = upper[i * n + j];
      const double* below = inverse + j * n;
      for (std::size_t k = j; k < n; ++k) row[k] += share * below[k];
    }
    const double scale = 1.0 / upper[i * n + i];
    for (std::size_t k = i + 1; k < n; ++k) row[k] *= -scale;
    row[i] = scale;
  }
}

}  // namespace plantar
