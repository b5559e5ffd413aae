// Where up is, from gyroscope and accelerometer: for robots whose logs hold no attitude.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plantar {

constexpr double BLEND_FREQUENCY = 0.03;  // Hz: below it the accelerometer tells where up is, above it the gyroscope

// A complementary filter on a quaternion w x y z, IMU to world. Yaw starts at 0 and drifts.
class AttitudeFilter {
 public:
  using Quaternion = std::array<double, 4>;

  void restart() noexcept { started_ = false; }

  // rate: mean of the last two samples [rad/s]; acceleration: proper [m/s²], both in the IMU's frame.
  const Quaternion& step(const double* rate, const double* acceleration, double dt) noexcept {
    const double size = std::sqrt(acceleration[0] * acceleration[0] + acceleration[1] * acceleration[1] +
                                  acceleration[2] * acceleration[2]);
    if (!(size > 0.0)) return q_;
    const double a[3] = {acceleration[0] / size, acceleration[1] / size, acceleration[2] / size};
    if (!started_) {
      // The shortest turn that takes the reading to the vertical.
      q_ = a[2] > -0.999999 ? Quaternion{1.0 + a[2], a[1], -a[0], 0.0} : Quaternion{0.0, 1.0, 0.0, 0.0};
      normalise();
      started_ = true, age_ = 0.0;
      return q_;
    }
    age_ += dt;
    const auto [w, x, y, z] = q_;
    // The world's up in the IMU's frame; the reading is turned onto it, slowly: at first as a mean of all readings.
    const double up[3] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
    const double gain = std::max(2 * std::numbers::pi * BLEND_FREQUENCY, 1.0 / age_);
    const double vx = (rate[0] + gain * (a[1] * up[2] - a[2] * up[1])) * dt / 2;
    const double vy = (rate[1] + gain * (a[2] * up[0] - a[0] * up[2])) * dt / 2;
    const double vz = (rate[2] + gain * (a[0] * up[1] - a[1] * up[0])) * dt / 2;
    const double angle = std::sqrt(vx * vx + vy * vy + vz * vz);
    const double s = angle > 1e-12 ? std::sin(angle) / angle : 1.0, c = std::cos(angle);
    q_ = {c * w - s * (vx * x + vy * y + vz * z), c * x + s * (w * vx + y * vz - z * vy),
          c * y + s * (w * vy + z * vx - x * vz), c * z + s * (w * vz + x * vy - y * vx)};
    normalise();
    return q_;
  }

 private:
  void normalise() noexcept {
    const double length = std::sqrt(q_[0] * q_[0] + q_[1] * q_[1] + q_[2] * q_[2] + q_[3] * q_[3]);
    for (double& part : q_) part /= length;
  }

  Quaternion q_ = {1.0, 0.0, 0.0, 0.0};
  bool started_ = false;
  double age_ = 0.0;
};

}  // namespace plantar
