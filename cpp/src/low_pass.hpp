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

// Rows of a signal of k columns that are filtered at a time: a megabyte of them.
inline std::size_t low_pass_block(std::size_t k) { return (std::size_t{1} << 17) / (k < 8 ? 8 : k) + 1; }

// Doubles of work that n rows take: the states of every column at both ends of every block, and LANES columns of one.
inline std::size_t low_pass_work(std::size_t n, std::size_t k, std::size_t padding, std::size_t lanes) {
  const std::size_t block = low_pass_block(k), rows = n + 2 * padding;
  return (4 * (rows / block + 2) * ((k + lanes - 1) / lanes) + (rows < block ? rows : block)) * lanes;
}

}  // namespace plantar
