// A spring that relaxes through a damper of its own, along an evenly sampled deflection.
#pragma once

#include <cstddef>

namespace plantar {

// x (n, b) of b variants: begun at `start` (b,), from sample to sample it keeps `decay` (b,) of itself and takes on
// `gain` (b,) of the step of `deflection` (n,).
inline void relax(const double* deflection, std::size_t n, const double* decay, const double* gain,
                  const double* start, std::size_t b, double* x) {
  for (std::size_t i = 0; i < n; ++i, x += b) {
    const double step = i ? deflection[i] - deflection[i - 1] : 0.0;
    for (std::size_t k = 0; k < b; ++k) x[k] = i ? decay[k] * x[k - b] + gain[k] * step : start[k];
  }
}

}  // namespace plantar
