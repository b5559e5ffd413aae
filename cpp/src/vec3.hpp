// Vectors and rotations of space, one per lane.
#pragma once

#include "lanes.hpp"

namespace plantar::PLANTAR_ISA {

struct Vec3 {
  Lanes x, y, z;
};

PLANTAR_INLINE Vec3 splat3(const double* p) { return {splat(p[0]), splat(p[1]), splat(p[2])}; }
PLANTAR_INLINE Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
PLANTAR_INLINE Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PLANTAR_INLINE Vec3 operator*(Lanes k, Vec3 a) { return {k * a.x, k * a.y, k * a.z}; }
PLANTAR_INLINE Vec3 operator*(double k, Vec3 a) { return {k * a.x, k * a.y, k * a.z}; }
PLANTAR_INLINE Lanes dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PLANTAR_INLINE Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A rotation by its columns: the axes of the rotated frame.
struct Mat3 {
  Vec3 x, y, z;
};

PLANTAR_INLINE Vec3 operator*(const Mat3& m, Vec3 a) {
  return {m.x.x * a.x + m.y.x * a.y + m.z.x * a.z, m.x.y * a.x + m.y.y * a.y + m.z.y * a.z,
          m.x.z * a.x + m.y.z * a.y + m.z.z * a.z};
}
PLANTAR_INLINE Vec3 transposed(const Mat3& m, Vec3 a) { return {dot(m.x, a), dot(m.y, a), dot(m.z, a)}; }
PLANTAR_INLINE Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.x, a * b.y, a * b.z}; }

// By a constant rotation, row-major, the same for all lanes, and back.
PLANTAR_INLINE Vec3 turned(const double* r, Vec3 a) {
  return {r[0] * a.x + r[1] * a.y + r[2] * a.z, r[3] * a.x + r[4] * a.y + r[5] * a.z,
          r[6] * a.x + r[7] * a.y + r[8] * a.z};
}
PLANTAR_INLINE Vec3 turned_back(const double* r, Vec3 a) {
  return {r[0] * a.x + r[3] * a.y + r[6] * a.z, r[1] * a.x + r[4] * a.y + r[7] * a.z,
          r[2] * a.x + r[5] * a.y + r[8] * a.z};
}

// Times a constant matrix or vector, row-major: of doubles, the same for all lanes, or of `LaneRows`.
template <class Numbers>
PLANTAR_INLINE Vec3 times(const Mat3& m, Numbers v) {
  return v[0] * m.x + v[1] * m.y + v[2] * m.z;
}
template <class Numbers>
PLANTAR_INLINE Mat3 times_matrix(const Mat3& m, Numbers r) {
  return {r[0] * m.x + r[3] * m.y + r[6] * m.z, r[1] * m.x + r[4] * m.y + r[7] * m.z,
          r[2] * m.x + r[5] * m.y + r[8] * m.z};
}

}  // namespace plantar::PLANTAR_ISA
