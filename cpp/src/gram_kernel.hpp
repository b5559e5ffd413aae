// BᵀB of a block of rows, and its Cholesky factor: half the arithmetic of Householder's reflections, all of it matrix
// product. The condition number is squared, so the factor says whether that was safe.
//
// Vectors run down the columns: no transposition, and a tile's sums stay in registers until the block ends.
#pragma once

#include "lanes.hpp"
#include "qr.hpp"

namespace plantar::PLANTAR_ISA {

// Tiles whose sums, with one vector of each of their rows, fill the registers.
constexpr int TILE_ROWS = LANES == 8 ? 4 : 3;
constexpr int TILE_COLUMNS = LANES == 8 ? 6 : 4;
constexpr int TILES_AT_ONCE = 2;  // tiles of columns that stay in the first-level cache while all rows pass
static_assert(TILE_COLUMNS <= QR_SLACK && TILE_ROWS <= TILE_COLUMNS);

// The sums of LANES vectors, in their order: each round interleaves and adds the first half of them and the second.
template <int COUNT = LANES>
PLANTAR_INLINE Lanes sums_of(const Lanes* x) {
  Lanes y[COUNT / 2];
  for (int k = 0; k < COUNT / 2; ++k)
    y[k] = interleave_low(x[k], x[k + COUNT / 2]) + interleave_high(x[k], x[k + COUNT / 2]);
  if constexpr (COUNT > 2) return sums_of<COUNT / 2>(y);
  else return y[0];
}

// out[c * ROWS + k] = column k of a times column c of b.
template <int ROWS, int COLUMNS>
PLANTAR_INLINE void tile_products(const double* a, const double* b, std::size_t stride, std::size_t length,
                                  double* out) {
  static_assert(ROWS * COLUMNS % LANES == 0);
  Lanes sums[ROWS * COLUMNS];
  for (int k = 0; k < ROWS * COLUMNS; ++k) sums[k] = Lanes{};
  for (std::size_t i = 0; i < length; i += LANES) {
    Lanes x[ROWS];
    for (int k = 0; k < ROWS; ++k) x[k] = load(a + k * stride + i);
    for (int c = 0; c < COLUMNS; ++c) {
      const Lanes y = load(b + c * stride + i);
      for (int k = 0; k < ROWS; ++k) sums[c * ROWS + k] += x[k] * y;
    }
  }
  for (int k = 0; k < ROWS * COLUMNS; k += LANES) store(out + k, sums_of(sums + k));
}

// gram's upper triangle grows by BᵀB, both column-major; `columns` may end within the slack of zeros.
inline void gram_update(double* gram, std::size_t gram_stride, const double* b, std::size_t b_stride,
                        std::size_t rows, std::size_t columns) {
  constexpr std::size_t GROUP = TILES_AT_ONCE * TILE_COLUMNS;
  double products[TILE_ROWS * TILE_COLUMNS];
  for (std::size_t first = 0; first < columns; first += GROUP) {
    const std::size_t end = first + GROUP < columns ? first + GROUP : columns;
    for (std::size_t i = 0; i < end; i += TILE_ROWS) {
      for (std::size_t j = first; j < end; j += TILE_COLUMNS) {
        if (i >= j + TILE_COLUMNS) continue;
        tile_products<TILE_ROWS, TILE_COLUMNS>(b + i * b_stride, b + j * b_stride, b_stride, rows, products);
        double* out = gram + i + j * gram_stride;
        for (int c = 0; c < TILE_COLUMNS; ++c)
          for (int k = 0; k < TILE_ROWS; ++k) out[c * gram_stride + k] += products[c * TILE_ROWS + k];
      }
    }
  }
}

// An upper estimate of the condition number of R, whose columns have length one: LINPACK's, sharpened by one step.
// x: n doubles of work.
inline double condition_estimate(const double* r, std::size_t stride, std::size_t n, double* x) {
  // Rᵀ x = ±1, each sign the one that makes x grow.
  for (std::size_t j = 0; j < n; ++j) {
    const double* column = r + j * stride;
    double sum = 0.0;
    for (std::size_t i = 0; i < j; ++i) sum += column[i] * x[i];
    x[j] = (sum > 0.0 ? -1.0 - sum : 1.0 - sum) / column[j];
  }
  double growth = 0.0, before = 0.0, after = 0.0;
  const auto upwards = [&] {
    before = after = 0.0;
    for (std::size_t i = 0; i < n; ++i) before += x[i] * x[i];
    for (std::size_t j = n; j-- > 0;) {
      const double* column = r + j * stride;
      const double value = x[j] / column[j];
      for (std::size_t i = 0; i < j; ++i) x[i] -= value * column[i];
      x[j] = value;
      after += value * value;
    }
    growth = __builtin_sqrt(after / before);
  };
  upwards();
  const double scale = 1.0 / __builtin_sqrt(after);
  for (std::size_t j = 0; j < n; ++j) {
    const double* column = r + j * stride;
    double sum = 0.0;
    for (std::size_t i = 0; i < j; ++i) sum += column[i] * x[i];
    x[j] = (x[j] * scale - sum) / column[j];
  }
  upwards();
  return __builtin_sqrt(static_cast<double>(n)) * growth;
}

// R with RᵀR = gram, both column-major; false where the columns, scaled to length one, are conditioned worse than
// `safe`; columns of zeros do not count. The last is the measured side: what is left of it may be small, but not below
// 1 / safe of it. `r` begins as zeros, padded as a Triangle; `work`: 2 n doubles.
inline bool cholesky(const double* gram, std::size_t gram_stride, std::size_t n, double safe, double* r,
                     std::size_t stride, double* work) {
  constexpr int BLOCK = LANES == 8 ? 8 : 4;  // vectors of R begin at multiples of it
  constexpr int PART = BLOCK / 2;
  double *scale = work, *vector = work + n;
  for (std::size_t j = 0; j < n; ++j) {
    const double square = gram[j + j * gram_stride];
    if (!(square >= 0.0)) return false;
    scale[j] = square > 0.0 ? 1.0 / __builtin_sqrt(square) : 0.0;
  }
  double products[PART * PART], block[BLOCK][BLOCK];
  for (std::size_t j0 = 0; j0 < n; j0 += BLOCK) {
    for (std::size_t i0 = 0; i0 <= j0; i0 += BLOCK) {
      for (int cp = 0; cp < BLOCK; cp += PART) {
        for (int kp = 0; kp < BLOCK; kp += PART) {
          tile_products<PART, PART>(r + (i0 + kp) * stride, r + (j0 + cp) * stride, stride, i0, products);
          for (int c = 0; c < PART; ++c) {
            for (int k = 0; k < PART; ++k) {
              const std::size_t i = i0 + kp + k, j = j0 + cp + c;
              const bool within = i < n && j < n && i <= j;
              block[cp + c][kp + k] =
                  within ? gram[i + j * gram_stride] * scale[i] * scale[j] - products[c * PART + k] : 0.0;
            }
          }
        }
      }
      for (int c = 0; c < BLOCK && j0 + c < n; ++c) {
        double* column = r + (j0 + c) * stride + i0;
        for (int k = 0; k < BLOCK && i0 + k <= j0 + c; ++k) {
          const double* above = r + (i0 + k) * stride + i0;
          double rest = block[c][k];
          for (int l = 0; l < k; ++l) rest -= above[l] * column[l];
          if (i0 + k < j0 + c) {
            column[k] = rest / above[k];
          } else if (scale[j0 + c] == 0.0) {
            column[k] = 1.0;  // for now: nothing else stands in its column or row
          } else {
            if (!(rest * safe * safe > 1.0)) return false;
            column[k] = __builtin_sqrt(rest);
          }
        }
      }
    }
  }
  if (!(condition_estimate(r, stride, n - 1, vector) < safe)) return false;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i <= j; ++i) r[i + j * stride] = scale[j] > 0.0 ? r[i + j * stride] / scale[j] : 0.0;
  return true;
}

}  // namespace plantar::PLANTAR_ISA
