// Arrays of Python as the kernels see them, and the table of kernels by name.
#pragma once

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "kernels.hpp"

namespace plantar {

using Vector = nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::device::cpu>;
using Matrix = nanobind::ndarray<const double, nanobind::ndim<2>, nanobind::device::cpu>;
using Packed = nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;

inline const Kernels& kernels(const std::string& isa) {
  const Kernels* const* table = runnable_kernels();
  if (isa.empty()) return **table;
  for (; *table != nullptr; ++table)
    if (isa == (*table)->name) return **table;
  throw std::invalid_argument("this processor or build lacks the instruction set " + isa);
}

inline Column column(const Vector& v, std::size_t n) {
  if (v.shape(0) != n) throw std::invalid_argument("columns of different length");
  return {v.data(), v.stride(0)};
}

template <std::size_t K>
void columns(const Matrix& m, std::size_t n, Column (&out)[K]) {
  if (m.shape(0) != n || m.shape(1) != K) throw std::invalid_argument("an array of the wrong shape");
  for (std::size_t k = 0; k < K; ++k) out[k] = {m.data() + static_cast<std::ptrdiff_t>(k) * m.stride(1), m.stride(0)};
}

inline Frame frame(const Packed& twelve) {
  if (twelve.shape(0) != 12) throw std::invalid_argument("a frame is nine numbers of rotation and three of origin");
  Frame out;
  std::copy_n(twelve.data(), 9, out.rotation);
  std::copy_n(twelve.data() + 9, 3, out.origin);
  return out;
}

}  // namespace plantar
