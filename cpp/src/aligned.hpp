// Memory for vectors: aligned to a cache line, zeroed, freed with its owner.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

namespace plantar {

constexpr std::size_t CACHE_LINE = 64;

struct AlignedDelete {
  void operator()(double* p) const { ::operator delete[](p, std::align_val_t(CACHE_LINE)); }
};

using Aligned = std::unique_ptr<double[], AlignedDelete>;

inline Aligned aligned_bytes(std::size_t bytes) {
  auto* p = static_cast<double*>(::operator new[](bytes, std::align_val_t(CACHE_LINE)));
  std::memset(p, 0, bytes);
  return Aligned(p);
}

inline Aligned aligned_doubles(std::size_t count) { return aligned_bytes(count * sizeof(double)); }

}  // namespace plantar
