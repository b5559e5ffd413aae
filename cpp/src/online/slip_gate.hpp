// Slip: two soles that stand cannot move against each other, nor turn.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "online/foot_kinematics.hpp"
#include "online/one_pole.hpp"
#include "online/running_quantile.hpp"

namespace plantar {

constexpr double SLIP_CUTOFF = 10.0;    // Hz: motion of the soles above it is noise
constexpr double LEAST_SPEED = 0.002;   // m/s
constexpr double YAW_MOMENT_ARM = 0.1;  // m: of half a sole, for speeds about z
constexpr double USUAL_SHARE = 0.8;     // of the time a speed is noise, however much slides
constexpr double USUAL_SPEED = 1.794;   // that quantile of a plane vector's length, in deviations of its components
constexpr double SURE = 5.0;            // deviations: no noise
constexpr double POSSIBLE = 3.5;        // deviations: part of a slide
constexpr double LEAST_PATH = 0.0009;   // m that a slide must cover
constexpr double SLIP_PAUSE = 0.1;      // s: slides that are closer are one

class SlipGate {
 public:
  enum class Verdict { none, possible, sure };

  void restart() noexcept { samples_ = 0, path_ = 0.0, sure_ = false; }

  Verdict step(const SolePlace& left, const SolePlace& right, double dt) noexcept {
    const double c = std::cos(left.heading), s = std::sin(left.heading);
    const double x = right.x - left.x, y = right.y - left.y, yaw = right.heading - left.heading;
    const double turned = std::abs(yaw) > std::numbers::pi ? yaw - std::copysign(2.0 * std::numbers::pi, yaw) : yaw;
    const std::array<double, 3> apart = {c * x + s * y, c * y - s * x, YAW_MOMENT_ARM * turned};
    const double blend = followed_in_band(SLIP_CUTOFF, dt);
    double square = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double before = twice_[i];
      once_[i] = samples_ == 0 ? apart[i] : once_[i] + blend * (apart[i] - once_[i]);
      twice_[i] = samples_ == 0 ? apart[i] : twice_[i] + blend * (once_[i] - twice_[i]);
      const double speed = samples_ == 0 ? 0.0 : (twice_[i] - before) / dt;
      square += speed * speed;
    }
    const double speed = std::sqrt(square);
    settled_ = samples_ == 0 ? 0.0 : settled_ + dt;
    ++samples_;
    if (settled_ < 1.0 / SLIP_CUTOFF) return Verdict::possible;  // the filter's own start
    usual_.see(speed, dt);
    const double deviation = usual_.value() / USUAL_SPEED;
    if (speed > std::max(LEAST_SPEED, POSSIBLE * deviation)) {
      path_ += speed * dt, rest_ = 0.0;
      sure_ = sure_ || speed > std::max(LEAST_SPEED, SURE * deviation);
    } else if ((rest_ += dt) > SLIP_PAUSE) {
      path_ = 0.0, sure_ = false;
    }
    return sure_ && path_ > LEAST_PATH ? Verdict::sure : path_ > 0.0 ? Verdict::possible : Verdict::none;
  }

 private:
  std::array<double, 3> once_ = {}, twice_ = {};
  double settled_ = 0.0, path_ = 0.0, rest_ = 0.0;
  bool sure_ = false;
  int samples_ = 0;
  RunningQuantile usual_{USUAL_SHARE, 5.0};
};

}  // namespace plantar
