// The shapes that a streaming QR works on. Columns are padded with zeros to whole panels, plus slack for strips.
#pragma once

#include <cstddef>

namespace plantar {

constexpr std::size_t QR_PANEL = 16;
constexpr std::size_t QR_SLACK = 12;
constexpr std::size_t QR_ROWS = 32;       // rows of a block come in multiples of this
constexpr std::size_t QR_MAX_ROWS = 256;

constexpr std::size_t round_up(std::size_t x, std::size_t to) { return (x + to - 1) / to * to; }

// Upper triangle, column-major: `columns` is a multiple of QR_PANEL; QR_SLACK more columns of zeros follow.
struct Triangle {
  double* data;
  std::size_t columns;
  std::size_t stride;
};

// Rows to take in, column-major, destroyed. `active`, where given: how many of the rows can be nonzero left of the
// end of each panel, for rows that form a triangle themselves.
struct Block {
  double* data;
  std::size_t rows;
  std::size_t stride;
  const std::size_t* active;
};

}  // namespace plantar
