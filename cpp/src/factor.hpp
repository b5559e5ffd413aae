// One upper triangle that rows stream into, with its storage: R of a QR of all rows seen so far.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "aligned.hpp"
#include "kernels.hpp"

namespace plantar {

// Up to this condition number, of columns scaled to length one, a factor by way of BᵀB is right to 1e-8 of itself.
constexpr double SAFE_TO_SQUARE = 1e4;

class Factor {
 public:
  explicit Factor(std::size_t columns)
      : columns_(columns),
        padded_(round_up(std::max<std::size_t>(columns, 1), QR_PANEL)),
        data_(aligned_doubles(padded_ * (padded_ + QR_SLACK))) {}

  std::size_t columns() const { return columns_; }

  // Memory for a block of rows for this factor: all padding columns are zero and stay so.
  static constexpr std::size_t block_stride = QR_MAX_ROWS + 8;  // not a power of two: columns share no cache set
  Aligned new_block() const { return aligned_doubles(block_stride * (padded_ + QR_SLACK)); }

  void take(const Kernels& kernels, double* block, std::size_t rows, const std::size_t* active, void* work) {
    empty_ = false;
    kernels.qr_update({data_.get(), padded_, padded_}, {block, round_up(rows, QR_ROWS), block_stride, active}, work);
  }

  // Take in another factor's rows, times `weight`, its column k standing at onto[k] (increasing).
  void take(const Kernels& kernels, const double* upper, std::size_t size, const std::int32_t* onto, double weight) {
    if (empty_ && size == columns_) {
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t k = i; k < size; ++k) data_[i + k * padded_] = weight * upper[i * size + k];
      empty_ = false;
      return;
    }
    Aligned block = new_block(), work = aligned_bytes(kernels.qr_work);
    std::vector<std::size_t> active(padded_ / QR_PANEL);
    for (std::size_t first = 0; first < size; first += QR_MAX_ROWS) {
      const std::size_t rows = std::min(QR_MAX_ROWS, size - first);
      std::fill_n(block.get(), block_stride * (padded_ + QR_SLACK), 0.0);
      for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t k = first + i; k < size; ++k)
          block[onto[k] * block_stride + i] = weight * upper[(first + i) * size + k];
      for (std::size_t panel = 0; panel < active.size(); ++panel) {
        const auto end = static_cast<std::int32_t>((panel + 1) * QR_PANEL);
        const auto reached = std::lower_bound(onto + first, onto + first + rows, end) - (onto + first);
        active[panel] = round_up(static_cast<std::size_t>(reached), QR_ROWS);
      }
      take(kernels, block.get(), rows, active.data(), work.get());
    }
  }

  // Memory for BᵀB of this factor's rows: column-major, with room for the tiles that end beyond the last column.
  std::size_t gram_stride() const { return padded_ + QR_SLACK; }
  std::size_t gram_size() const { return gram_stride() * gram_stride(); }
  Aligned new_gram() const { return aligned_doubles(gram_size()); }

  // Take in rows whose BᵀB is given; false, and unchanged, where that squares too large a condition number.
  bool take_gram(const Kernels& kernels, const double* gram) {
    Factor taken(columns_);
    std::vector<double> work(2 * columns_);
    if (!kernels.cholesky(gram, gram_stride(), columns_, SAFE_TO_SQUARE, taken.data_.get(), padded_, work.data()))
      return false;
    taken.empty_ = false;
    if (empty_) {
      *this = std::move(taken);
    } else {
      take(kernels, taken);
    }
    return true;
  }

  // Become the sum of two factors of the same columns.
  void take(const Kernels& kernels, const Factor& other) {
    if (other.empty_) return;
    std::vector<double> upper(columns_ * columns_);
    std::vector<std::int32_t> onto(columns_);
    for (std::size_t k = 0; k < columns_; ++k) onto[k] = static_cast<std::int32_t>(k);
    other.copy_upper(upper.data());
    take(kernels, upper.data(), columns_, onto.data(), 1.0);
  }

  // The triangle, row-major, (columns, columns), zeros below the diagonal.
  void copy_upper(double* out) const {
    for (std::size_t i = 0; i < columns_; ++i)
      for (std::size_t k = 0; k < columns_; ++k) out[i * columns_ + k] = k < i ? 0.0 : data_[i + k * padded_];
  }

 private:
  std::size_t columns_, padded_;
  bool empty_ = true;
  Aligned data_;
};

}  // namespace plantar
