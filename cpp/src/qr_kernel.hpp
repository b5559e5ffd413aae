// One step of a streaming QR: an upper triangle R takes in a block of rows B, so that RᵀR grows by BᵀB.
//
// Householder vectors have the shape [e_j; v], the unit on R's diagonal and v in B: nothing below R's diagonal
// is ever touched and R's size never grows. Panels of PANEL columns; the columns right of a panel are updated in
// narrow strips, each read and written once while it stays in the first-level cache.
#pragma once

#include "lanes.hpp"
#include "qr.hpp"

namespace plantar::PLANTAR_ISA {

// Strips are STRIP columns wide: two vectors of PANEL entries times STRIP sums fit the registers.
constexpr int STRIP = LANES == 8 ? 12 : LANES == 4 ? 6 : 4;
constexpr int UPDATE_ROWS = LANES == 8 ? 4 : 2;  // vectors of rows updated at once
constexpr int UPDATE_COLUMNS = LANES == 8 ? 6 : LANES == 4 ? 6 : 4;
static_assert(QR_SLACK % STRIP == 0 && STRIP % UPDATE_COLUMNS == 0 && QR_ROWS % (UPDATE_ROWS * LANES) == 0);
static_assert(QR_ROWS % (4 * LANES) == 0);
static_assert(QR_PANEL % (2 * LANES) == 0);

struct Panel {
  Lanes across[QR_MAX_ROWS * QR_PANEL / LANES];  // the panel's vectors, row by row
  double t[QR_PANEL][QR_PANEL];                  // upper triangle: Qᵀ = 1 - V Tᵀ Vᵀ
  double w[STRIP][QR_PANEL];
};

// sums[k] = column k of b times x, for `count` columns of b.
PLANTAR_INLINE void products(const double* b, std::size_t b_stride, const double* x, std::size_t rows, int count,
                             double* sums) {
  int k = 0;
  for (; k + 8 <= count; k += 8) {
    Lanes dots[8] = {};
    const double* first = b + k * b_stride;
    for (std::size_t i = 0; i < rows; i += LANES) {
      const Lanes y = load(x + i);
      for (int c = 0; c < 8; ++c) dots[c] += y * load(first + c * b_stride + i);
    }
    for (int c = 0; c < 8; ++c) sums[k + c] = sum(dots[c]);
  }
  for (; k < count; k += 2) {
    // An odd count takes one column too many: it stands in the panel too, and its sum is not used.
    Lanes dots[4] = {};
    const double *first = b + k * b_stride, *second = first + b_stride;
    for (std::size_t i = 0; i < rows; i += 2 * LANES) {
      const Lanes y0 = load(x + i), y1 = load(x + i + LANES);
      dots[0] += y0 * load(first + i);
      dots[1] += y0 * load(second + i);
      dots[2] += y1 * load(first + i + LANES);
      dots[3] += y1 * load(second + i + LANES);
    }
    sums[k] = sum(dots[0] + dots[2]);
    sums[k + 1] = sum(dots[1] + dots[3]);
  }
}

// Householder on the panel's own columns, each brought up to date when its turn comes; leaves the vectors in b and
// the triangle in `panel.t`.
inline void factor_panel(double* r, std::size_t r_stride, double* b, std::size_t b_stride, std::size_t rows,
                         Panel& panel) {
  double dots[QR_PANEL + 1], w[QR_PANEL];
  for (int j = 0; j < static_cast<int>(QR_PANEL); ++j) {
    double* v = b + j * b_stride;
    double* above = r + j * r_stride;
    products(b, b_stride, v, rows, j, dots);
    for (int i = 0; i < j; ++i) {
      w[i] = 0.0;
      for (int k = 0; k <= i; ++k) w[i] += panel.t[k][i] * (above[k] + dots[k]);
    }
    for (int i = 0; i < j; ++i) above[i] -= w[i];
    Lanes square = Lanes{};
    for (std::size_t i = 0; i < rows; i += 4 * LANES) {
      Lanes x[4];
      for (int l = 0; l < 4; ++l) x[l] = load(v + i + l * LANES);
      for (int k = 0; k < j; ++k)
        for (int l = 0; l < 4; ++l) x[l] -= w[k] * load(b + k * b_stride + i + l * LANES);
      for (int l = 0; l < 4; ++l) store(v + i + l * LANES, x[l]);
      square += (x[0] * x[0] + x[1] * x[1]) + (x[2] * x[2] + x[3] * x[3]);
    }
    const double norm2 = sum(square), alpha = above[j];
    for (int k = 0; k < static_cast<int>(QR_PANEL); ++k) panel.t[k][j] = 0.0;
    if (norm2 == 0.0) continue;
    const double beta = alpha > 0.0 ? -__builtin_sqrt(alpha * alpha + norm2) : __builtin_sqrt(alpha * alpha + norm2);
    const double tau = (beta - alpha) / beta, scale = 1.0 / (alpha - beta);
    above[j] = beta;
    for (std::size_t i = 0; i < rows; i += LANES) store(v + i, scale * load(v + i));
    // T's next column: -tau T (Vᵀ v).
    products(b, b_stride, v, rows, j, dots);
    panel.t[j][j] = tau;
    for (int i = 0; i < j; ++i) {
      double total = 0.0;
      for (int k = i; k < j; ++k) total += panel.t[i][k] * dots[k];
      panel.t[i][j] = -tau * total;
    }
  }
}

// The panel's vectors row by row, in squares of LANES by LANES: log2(LANES) rounds of interleaving transpose one.
inline void transpose_panel(const double* b, std::size_t b_stride, std::size_t rows, Panel& panel) {
  constexpr int HALF = LANES / 2;
  for (std::size_t i = 0; i < rows; i += LANES) {
    for (int k = 0; k < static_cast<int>(QR_PANEL); k += LANES) {
      Lanes x[LANES], y[LANES];
      for (int c = 0; c < LANES; ++c) x[c] = load(b + (k + c) * b_stride + i);
      for (int round = 1; round < LANES; round *= 2) {
        for (int c = 0; c < HALF; ++c) {
          y[2 * c] = interleave_low(x[c], x[c + HALF]);
          y[2 * c + 1] = interleave_high(x[c], x[c + HALF]);
        }
        for (int c = 0; c < LANES; ++c) x[c] = y[c];
      }
      for (int c = 0; c < LANES; ++c) panel.across[((i + c) * QR_PANEL + k) / LANES] = x[c];
    }
  }
}

// w = Tᵀ (R's rows + Vᵀ B) for one strip; R's rows less w.
inline void project_strip(double* r, std::size_t r_stride, const double* b, std::size_t b_stride, std::size_t rows,
                          Panel& panel) {
  constexpr int VECTORS = QR_PANEL / LANES;
  for (int p = 0; p < VECTORS; p += 2) {
    Lanes sums[STRIP][2];
    for (int c = 0; c < STRIP; ++c)
      for (int k = 0; k < 2; ++k) sums[c][k] = load(r + c * r_stride + (p + k) * LANES);
    const Lanes* across = panel.across + p;
    for (std::size_t i = 0; i < rows; ++i, across += VECTORS) {
      const Lanes v0 = across[0], v1 = across[1];
      for (int c = 0; c < STRIP; ++c) {
        const double x = b[c * b_stride + i];
        sums[c][0] += v0 * x;
        sums[c][1] += v1 * x;
      }
    }
    for (int c = 0; c < STRIP; ++c)
      for (int k = 0; k < 2; ++k) store(panel.w[c] + (p + k) * LANES, sums[c][k]);
  }
  for (int c = 0; c < STRIP; ++c) {
    Lanes out[VECTORS] = {};
    for (std::size_t i = 0; i < QR_PANEL; ++i)
      for (int k = 0; k < VECTORS; ++k) out[k] += panel.w[c][i] * load(panel.t[i] + k * LANES);
    for (int k = 0; k < VECTORS; ++k) {
      double* at = r + c * r_stride + k * LANES;
      store(panel.w[c] + k * LANES, out[k]);
      store(at, load(at) - out[k]);
    }
  }
}

// B -= V w for one strip.
inline void update_strip(double* b, std::size_t b_stride, const double* v, std::size_t rows, const Panel& panel) {
  constexpr int STEP = UPDATE_ROWS * LANES;
  for (std::size_t i = 0; i < rows; i += STEP) {
    for (int c0 = 0; c0 < STRIP; c0 += UPDATE_COLUMNS) {
      Lanes x[UPDATE_COLUMNS][UPDATE_ROWS];
      for (int c = 0; c < UPDATE_COLUMNS; ++c)
        for (int k = 0; k < UPDATE_ROWS; ++k) x[c][k] = load(b + (c0 + c) * b_stride + i + k * LANES);
      for (std::size_t p = 0; p < QR_PANEL; ++p) {
        const double* column = v + p * b_stride + i;
        Lanes y[UPDATE_ROWS];
        for (int k = 0; k < UPDATE_ROWS; ++k) y[k] = load(column + k * LANES);
        for (int c = 0; c < UPDATE_COLUMNS; ++c) {
          const double w = panel.w[c0 + c][p];
          for (int k = 0; k < UPDATE_ROWS; ++k) x[c][k] -= w * y[k];
        }
      }
      for (int c = 0; c < UPDATE_COLUMNS; ++c)
        for (int k = 0; k < UPDATE_ROWS; ++k) store(b + (c0 + c) * b_stride + i + k * LANES, x[c][k]);
    }
  }
}

inline void qr_update(const Triangle& r, const Block& block, void* work) {
  Panel& panel = *reinterpret_cast<Panel*>(work);
  for (std::size_t j = 0; j < r.columns; j += QR_PANEL) {
    const std::size_t rows = block.active != nullptr ? block.active[j / QR_PANEL] : block.rows;
    if (rows == 0) continue;
    double* v = block.data + j * block.stride;
    double* diagonal = r.data + j + j * r.stride;
    factor_panel(diagonal, r.stride, v, block.stride, rows, panel);
    transpose_panel(v, block.stride, rows, panel);
    for (std::size_t c = QR_PANEL; j + c < r.columns; c += STRIP) {
      double* strip = v + c * block.stride;
      project_strip(diagonal + c * r.stride, r.stride, strip, block.stride, rows, panel);
      update_strip(strip, block.stride, v, rows, panel);
    }
  }
}

constexpr std::size_t qr_work = sizeof(Panel);

}  // namespace plantar::PLANTAR_ISA
