// White noise of what one foot's regressions read, as much as their filter passes.
#pragma once

#include <array>
#include <numbers>

#include "online/white_noise.hpp"

namespace plantar {

constexpr double NOISE_ABOVE = 4.0;    // cutoffs: from there on a signal counts as noise
constexpr double NYQUIST_SHARE = 0.8;  // of the highest frequency, that this must stay below

class FootNoise {
 public:
  struct Signals {
    double angle[2], turning[2];  // of each axis; what the gyroscope adds to its rate
    double force[3];              // load, horizontal forces
    bool gyroscope;               // else rates come from the attitude
  };

  explicit FootNoise(double cutoff) noexcept : cutoff_(cutoff) {}

  void restart() noexcept {
    for (auto* noises : {&angle_, &turning_})
      for (WhiteNoise& noise : *noises) noise.restart();
    for (WhiteNoise& noise : force_) noise.restart();
  }

  // Samples that are too slow show no noise: variances are zero then.
  void follow(const Signals& now, double dt, double period) noexcept {
    const double band = 2.0 * cutoff_ * period;  // of all frequencies, those that pass
    const double share = NOISE_ABOVE * band < NYQUIST_SHARE ? band : 0.0;
    gyroscope = now.gyroscope;
    const double edge = 2.0 * std::numbers::pi * cutoff_;
    for (int a = 0; a < 2; ++a) {
      angle_[a].see(now.angle[a], dt), turning_[a].see(now.turning[a], dt);
      of_angle[a] = angle_[a].variance() * share;
      of_rate[a] = now.gyroscope ? turning_[a].variance() * share : of_angle[a] * edge * edge / 3.0;
    }
    for (int i = 0; i < 3; ++i) {
      force_[i].see(now.force[i], dt);
      of_force[i] = force_[i].variance() * share;
    }
  }

  // Variances behind the filter.
  double of_angle[2] = {}, of_rate[2] = {}, of_force[3] = {};
  bool gyroscope = false;  // whose noise that of the rates is

 private:
  double cutoff_;
  std::array<WhiteNoise, 2> angle_, turning_;
  std::array<WhiteNoise, 3> force_;
};

}  // namespace plantar
