// Samples from strided columns into lanes and back.
#pragma once

#include "columns.hpp"
#include "lanes.hpp"

namespace plantar::PLANTAR_ISA {

// Lanes beyond the last sample repeat it, so that no lane ever holds a number that nobody measured.
PLANTAR_INLINE Lanes gather(const Column& column, std::size_t first, std::size_t last) {
  Lanes x = Lanes{};
  if (column.data == nullptr) return x;
  const double* p = column.data + static_cast<std::ptrdiff_t>(first) * column.stride;
  if (first + LANES <= last && column.stride == 1) return load(p);
  for (int l = 0; l < LANES; ++l) {
    x[l] = *p;
    if (first + l + 1 < last) p += column.stride;
  }
  return x;
}

PLANTAR_INLINE void scatter(double* out, Lanes x, std::size_t count) {
  if (count >= LANES) {
    store(out, x);
  } else {
    for (std::size_t l = 0; l < count; ++l) out[l] = x[l];
  }
}

}  // namespace plantar::PLANTAR_ISA
