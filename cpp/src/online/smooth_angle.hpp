// An angle without most of its noise and without delay: what is quick in it comes from its rate.
//
// A complementary filter: gyroscope and encoders say how the angle changes, the attitude where it is.
#pragma once

#include <cmath>
#include <numbers>

#include "online/one_pole.hpp"

namespace plantar {

constexpr double ANGLE_BAND = 2.5;  // Hz: above it the gyroscope's noise is the smaller one, as in `identify feet`

// What white noise of the angle and of the rate leave in the smooth angle, as far as it goes with the noise itself,
// behind a low-pass: integrals of the complementary filter's two real parts over its band.
inline double smooth_share(double cutoff) noexcept { return ANGLE_BAND / cutoff * std::atan(cutoff / ANGLE_BAND); }
inline double smooth_lag(double cutoff) noexcept {
  return std::atan(cutoff / ANGLE_BAND) / (2.0 * std::numbers::pi * cutoff);
}

class SmoothAngle {
 public:
  void restart() noexcept { known_ = false; }

  // angle [rad] and rate [rad/s] of the same instant, `dt` behind the last ones.
  double pass(double angle, double rate, double dt) noexcept {
    const double blend = followed_in_band(ANGLE_BAND, dt);
    const double expected = angle_ + 0.5 * (rate + rate_) * dt;
    angle_ = known_ ? expected + blend * (angle - expected) : angle;
    rate_ = rate, known_ = true;
    return angle_;
  }

 private:
  bool known_ = false;
  double angle_ = 0.0, rate_ = 0.0;
};

}  // namespace plantar
