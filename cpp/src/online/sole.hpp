// Where the ground's force passes through the sole, and how deep inside its outline.
#pragma once

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

// Of a wrench at the bush's centre, in the sole's plane; false where the force along its normal is below `least`.
inline bool centre_of_pressure(const std::array<double, 6>& wrench, double pitch, double roll, const Frame& sole,
                               double least, Point& centre) noexcept {
  const double cp = std::cos(pitch), sp = std::sin(pitch), cr = std::cos(roll), sr = std::sin(roll);
  const auto onto_sole = [&](const double* v) {
    const double level = sp * v[0] + cp * v[2];
    return Vector3{cp * v[0] - sp * v[2], cr * v[1] + sr * level, cr * level - sr * v[1]};
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

// Distance of a point from the border of a convex outline, counter-clockwise; negative outside.
inline double depth(const std::vector<Point>& outline, const Point& at) noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double x = b[0] - a[0], y = b[1] - a[1];
    least = std::min(least, (x * (at[1] - a[1]) - y * (at[0] - a[0])) / std::sqrt(x * x + y * y));
  }
  return least;
}

}  // namespace plantar
