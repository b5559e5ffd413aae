// Where the ground's force passes through the sole, and how deep inside its outline.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "plantar/frame.hpp"

namespace plantar {

using Vector3 = std::array<double, 3>;
using Point = std::array<double, 2>;

inline Vector3 rotated(const double* r, const double* v) noexcept {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}
inline Vector3 rotated_back(const double* r, const double* v) noexcept {
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}
inline Vector3 cross(const double* a, const double* b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A wrench from its sensor's frame to the frame in which `sensor` is its placement.
inline std::array<double, 6> moved_wrench(const Frame& sensor, double sign, const double* wrench) noexcept {
  Vector3 force = rotated(sensor.rotation, wrench), torque = rotated(sensor.rotation, wrench + 3);
  const Vector3 moment = cross(sensor.origin, force.data());
  std::array<double, 6> out;
  for (int i = 0; i < 3; ++i) out[i] = sign * force[i], out[3 + i] = sign * (torque[i] + moment[i]);
  return out;
}

// Pitch and roll of a flat sole against its ankle.
struct Bend {
  double cos_pitch, sin_pitch, cos_roll, sin_roll;

  // up: the world's, in the bush frame, of length 1.
  explicit Bend(const double* up) noexcept {
    const double level = std::sqrt(up[0] * up[0] + up[2] * up[2]), over = 1.0 / std::max(level, 1e-12);
    cos_pitch = up[2] * over, sin_pitch = up[0] * over, cos_roll = level, sin_roll = -up[1];
  }
};

// Of a wrench at the bush's centre, in the sole's plane; false where the force along its normal is below `least`.
inline bool centre_of_pressure(const std::array<double, 6>& wrench, const Bend& bend, const Frame& sole, double least,
                               Point& centre) noexcept {
  const auto onto_sole = [&](const double* v) {
    const double level = bend.sin_pitch * v[0] + bend.cos_pitch * v[2];
    return Vector3{bend.cos_pitch * v[0] - bend.sin_pitch * v[2], bend.cos_roll * v[1] + bend.sin_roll * level,
                   bend.cos_roll * level - bend.sin_roll * v[1]};
  };
  const Vector3 force = onto_sole(wrench.data()), torque = onto_sole(wrench.data() + 3);
  const Vector3 arm = cross(sole.origin, force.data());
  const double left[3] = {torque[0] - arm[0], torque[1] - arm[1], torque[2] - arm[2]};
  const Vector3 moment = rotated_back(sole.rotation, left);
  const double normal = rotated_back(sole.rotation, force.data())[2];
  if (!(normal >= least)) return false;
  centre = {-moment[1] / normal, moment[0] / normal};
  return true;
}

// A convex outline, its corners counter-clockwise.
class Outline {
 public:
  explicit Outline(const std::vector<Point>& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const double x = b[0] - a[0], y = b[1] - a[1], length = std::sqrt(x * x + y * y);
      sides_.push_back({-y / length, x / length, (y * a[0] - x * a[1]) / length});
      for (int k = 0; k < 2; ++k) middle_[k] += a[k] / static_cast<double>(corners.size());
    }
  }

  // Distance of a point from the border; negative outside.
  double depth(const Point& at) const noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Side& side : sides_) least = std::min(least, side.x * at[0] + side.y * at[1] + side.inside);
    return least;
  }
  double middle_depth() const noexcept { return depth(middle_); }

 private:
  struct Side {
    double x, y;    // its normal, inwards
    double inside;  // the distance of the origin
  };
  std::vector<Side> sides_;
  Point middle_ = {0.0, 0.0};
};

}  // namespace plantar
