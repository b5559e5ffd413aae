// States of Jenkins elements along deflections that are cut into branches at their turning points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace plantar {

// r runs of n samples, cut into T branches at most. `direction` (T, r) is ±1, `length` (T, r) the way of each branch,
// and for each sample `branch` (n, r) its branch and `travelled` (n, r) the way since that began. Within a run branches
// only go up; samples behind one that goes down are padding.
struct BranchedRuns {
  std::size_t turns, runs, samples;
  const double *direction, *length;
  const std::int64_t* branch;
  const double* travelled;
};

// z (n, r, b) in [-1, 1] of b elements that slip at `slip` (b,), from `start` (r, b). On each branch z =
// direction·(place
// - 1): `place` is how far z stands from the end it came from, 0 to 2. Padding is 0.
inline void stop_operator(const BranchedRuns& given, const double* slip, const double* start, std::size_t b,
                          double* out) {
  std::vector<double> place(b);
  for (std::size_t run = 0; run < given.runs; ++run) {
    for (std::size_t k = 0; k < b; ++k)
      place[k] = 1.0 + given.direction[run] * std::clamp(start[run * b + k], -1.0, 1.0);
    std::int64_t at = 0;
    std::size_t i = 0;
    for (; i < given.samples; ++i) {
      const std::int64_t own = given.branch[i * given.runs + run];
      if (own < at) break;
      for (; at < own; ++at) {
        const double way = given.length[static_cast<std::size_t>(at) * given.runs + run];
        for (std::size_t k = 0; k < b; ++k) place[k] = std::max(2.0 - (place[k] + way / slip[k]), 0.0);
      }
      const double direction = given.direction[static_cast<std::size_t>(own) * given.runs + run];
      const double way = given.travelled[i * given.runs + run];
      double* z = out + (i * given.runs + run) * b;
      for (std::size_t k = 0; k < b; ++k) z[k] = direction * (std::min(place[k] + way / slip[k], 2.0) - 1.0);
    }
    for (; i < given.samples; ++i) std::fill_n(out + (i * given.runs + run) * b, b, 0.0);
  }
}

}  // namespace plantar
