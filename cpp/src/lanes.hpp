// One vector of samples: every kernel computes LANES samples at once.
//
// Compiled once per instruction set (see isa.cpp), each time inside its own namespace, so that no function
// built for a newer processor can be linked into the path of an older one. For the same reason this header
// and all that include it keep away from inline functions of the standard library.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#ifndef PLANTAR_ISA
#error "include this only from isa.cpp"
#endif

namespace plantar::PLANTAR_ISA {

constexpr int LANES = PLANTAR_LANES;

typedef double Lanes __attribute__((vector_size(8 * PLANTAR_LANES)));
typedef int64_t Bits __attribute__((vector_size(8 * PLANTAR_LANES)));
typedef double LanesUnaligned __attribute__((vector_size(8 * PLANTAR_LANES), aligned(8)));

#define PLANTAR_INLINE inline __attribute__((always_inline))

PLANTAR_INLINE Lanes splat(double x) { return Lanes{} + x; }
PLANTAR_INLINE Lanes load(const double* p) { return *reinterpret_cast<const LanesUnaligned*>(p); }
PLANTAR_INLINE void store(double* p, Lanes x) { *reinterpret_cast<LanesUnaligned*>(p) = x; }

// Numbers of which each lane has its own, one behind the other.
struct LaneRows {
  const double* data;
  PLANTAR_INLINE Lanes operator[](int row) const { return load(data + row * LANES); }
  PLANTAR_INLINE LaneRows operator+(int rows) const { return {data + rows * LANES}; }
};

PLANTAR_INLINE Lanes sqrt(Lanes x) {
  for (int l = 0; l < LANES; ++l) x[l] = __builtin_sqrt(x[l]);
  return x;
}

PLANTAR_INLINE Lanes abs(Lanes x) { return x < 0.0 ? -x : x; }

PLANTAR_INLINE double sum(Lanes x) {
  double total = 0.0;
  for (int l = 0; l < LANES; ++l) total += x[l];
  return total;
}

// The lower and the upper halves of two vectors, lane by lane in turn.
#if PLANTAR_LANES == 8
#define PLANTAR_LOW 0, 8, 1, 9, 2, 10, 3, 11
#define PLANTAR_HIGH 4, 12, 5, 13, 6, 14, 7, 15
#elif PLANTAR_LANES == 4
#define PLANTAR_LOW 0, 4, 1, 5
#define PLANTAR_HIGH 2, 6, 3, 7
#else
#define PLANTAR_LOW 0, 2
#define PLANTAR_HIGH 1, 3
#endif
PLANTAR_INLINE Lanes interleave_low(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, PLANTAR_LOW); }
PLANTAR_INLINE Lanes interleave_high(Lanes a, Lanes b) { return __builtin_shufflevector(a, b, PLANTAR_HIGH); }

// Sine and cosine to 1-2 ulp: three-part reduction by pi/2, then Taylor's polynomials, whose next terms are
// below 1e-17 on [-pi/4, pi/4]. Angles beyond 1e5 rad (or not finite) go to the C library.
PLANTAR_INLINE void sincos(Lanes x, Lanes& sine, Lanes& cosine) {
  const double magic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  const Lanes shifted = x * 0.63661977236758134308 + magic;
  const Bits quadrant = __builtin_bit_cast(Bits, shifted);
  const Lanes k = shifted - magic;
  const Lanes r = ((x - k * 0x1.921fb54400000p+0) - k * 0x1.0b4611a600000p-34) - k * 0x1.3198a2e037073p-69;
  const Lanes u = r * r;
  Lanes s = splat(1.0 / 355687428096000.0);
  s = s * u - 1.0 / 1307674368000.0;
  s = s * u + 1.0 / 6227020800.0;
  s = s * u - 1.0 / 39916800.0;
  s = s * u + 1.0 / 362880.0;
  s = s * u - 1.0 / 5040.0;
  s = s * u + 1.0 / 120.0;
  s = s * u - 1.0 / 6.0;
  s = r + r * u * s;
  Lanes c = splat(1.0 / 20922789888000.0);
  c = c * u - 1.0 / 87178291200.0;
  c = c * u + 1.0 / 479001600.0;
  c = c * u - 1.0 / 3628800.0;
  c = c * u + 1.0 / 40320.0;
  c = c * u - 1.0 / 720.0;
  c = c * u + 1.0 / 24.0;
  c = 1.0 - 0.5 * u + u * u * c;
  const Bits odd = (quadrant & 1) != 0;
  const Lanes a = odd ? c : s, b = odd ? s : c;
  sine = (quadrant & 2) != 0 ? -a : a;
  cosine = ((quadrant + 1) & 2) != 0 ? -b : b;
  const Bits far = !(abs(x) < 1e5);
  std::int64_t any = 0;
  for (int l = 0; l < LANES; ++l) any |= far[l];
  if (__builtin_expect(any != 0, 0)) {
    for (int l = 0; l < LANES; ++l) {
      if (far[l]) {
        sine[l] = __builtin_sin(x[l]);
        cosine[l] = __builtin_cos(x[l]);
      }
    }
  }
}

// atan2(y, x) to 2 ulp: a polynomial to 3e-6, then one exact correction by the sine of the remaining angle.
// (0, 0) gives 0.
PLANTAR_INLINE Lanes atan2(Lanes y, Lanes x) {
  const Lanes ax = abs(x), ay = abs(y);
  const Bits steep = ay > ax;
  const Lanes major = steep ? ay : ax, minor = steep ? ax : ay;
  const Lanes t = minor / (major == 0.0 ? splat(1.0) : major);
  const Lanes u = t * t;
  Lanes p = splat(-0.013422180409720581);
  p = p * u + 0.05733055160395569;
  p = p * u - 0.12110946092078502;
  p = p * u + 0.19558905081772535;
  p = p * u - 0.3329886305840137;
  p = p * u + 0.9999955067986463;
  const Lanes first = p * t;
  Lanes s, c;
  sincos(first, s, c);
  const Lanes d = (t * c - s) / sqrt(1.0 + u);  // the sine of the angle still missing
  Lanes angle = first + (d + d * d * d * (1.0 / 6.0));
  angle = steep ? 1.57079632679489661923 - angle : angle;
  angle = x < 0.0 ? 3.14159265358979323846 - angle : angle;
  return y < 0.0 ? -angle : angle;
}

}  // namespace plantar::PLANTAR_ISA
