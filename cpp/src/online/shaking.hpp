// Impacts: a force that changes faster than anything that loads a standing foot on purpose.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "online/one_pole.hpp"
#include "online/running_quantile.hpp"

namespace plantar {

constexpr double SHAKING_BAND = 20.0;   // Hz: no robot that stands is loaded on purpose so fast
constexpr double SHAKING_RATE = 0.06;   // of the sampling rate, that the band stays below: else nothing is above it
constexpr double SHAKING_TIME = 0.05;   // s over which shaking is judged
constexpr double SHAKING_SHARE = 0.02;  // of the weight, rms
constexpr double SHAKING_NOISE = 7.0;   // times the calmest shaking, which is the sensor's noise
constexpr double AFTER_IMPACT = 0.25;   // s left out behind it

class Shaking {
 public:
  explicit Shaking(double weight) noexcept : weight_(weight) {}

  // force: (3) [N]; whether an impact is going on or was just now.
  bool step(const double* force, double dt) noexcept {
    const double blend = followed_in_band(1.0, std::min(SHAKING_BAND * dt, SHAKING_RATE));
    double quick = 0.0;
    for (int i = 0; i < 3; ++i) {
      // Two poles: what is slow passes without being late by much of itself.
      once_[i] = first_ ? force[i] : once_[i] + blend * (force[i] - once_[i]);
      twice_[i] = first_ ? force[i] : twice_[i] + blend * (once_[i] - twice_[i]);
      const double rest = force[i] - 2 * once_[i] + twice_[i];
      quick += rest * rest;
    }
    first_ = false;
    square_ += followed_after(dt / SHAKING_TIME) * (quick - square_);
    const double size = std::sqrt(square_);
    calm_.see(size, dt);
    since_ = size > std::max(SHAKING_SHARE * weight_, SHAKING_NOISE * calm_.value()) ? 0.0 : since_ + dt;
    return since_ < AFTER_IMPACT;
  }

  void restart() noexcept { first_ = true, square_ = 0.0; }

 private:
  double weight_, square_ = 0.0, since_ = AFTER_IMPACT;
  std::array<double, 3> once_ = {}, twice_ = {};
  bool first_ = true;
  RunningQuantile calm_{0.1, 5.0};
};

}  // namespace plantar
