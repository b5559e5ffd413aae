// A low-pass as the kernels see it.
#pragma once

#include <cstddef>

namespace plantar {

// y = b (x + 2 x[-1] + x[-2]) - a1 y[-1] - a2 y[-2]
struct Section {
  double b, a1, a2;
};

// Two sections in series, run forth and back over `padding` samples more at each end; every nth sample is kept.
struct LowPass {
  Section sections[2];
  std::size_t padding, every;
};

// A signal of n rows of k columns, of which sample `first` is the first that is kept; `end` of the array that it is
// part of.
struct Rows {
  const double *values, *end;
  std::size_t n, k, first;
};

constexpr int LOW_PASS_VECTORS = 4;            // of columns, that are filtered together at most
constexpr std::size_t LOW_PASS_BLOCK = 1 << 14;  // vectors that are filtered forth and back before the next: a megabyte

// Doubles of work that n rows take: the states at both ends of every block, and one block.
inline std::size_t low_pass_work(std::size_t n, std::size_t padding, std::size_t lanes) {
  const std::size_t vectors = (n + 2 * padding) * LOW_PASS_VECTORS;
  const std::size_t states = 4 * (vectors / LOW_PASS_BLOCK + 2) * LOW_PASS_VECTORS;
  return (states + (vectors < LOW_PASS_BLOCK ? vectors : LOW_PASS_BLOCK)) * lanes;
}

}  // namespace plantar
