// Two feet whose stiffness and damping are known, and what their sensors read.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "plantar/foot_estimator.hpp"

namespace plantar {

inline constexpr double TRUE_STIFFNESS[2] = {900.0, 700.0}, TRUE_DAMPING[2] = {20.0, 30.0};
inline constexpr double TRUE_OFFSET[2] = {1.5, -0.7};
inline constexpr Frame HERE = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};

// The IMU sits on the ankle of both feet: the attitude is the deflection, turned round.
inline EstimatorModel two_feet(double delay = 0.0) {
  EstimatorModel model;
  model.weight = 600.0, model.wrench_delay = delay;
  model.joints = {"free"};
  for (const char* name : {"left", "right"}) {
    FootModel foot;
    foot.name = name;
    foot.bush = foot.sole = foot.sensor = HERE;
    foot.polygon = {{0.1, 0.06}, {-0.1, 0.06}, {-0.1, -0.06}, {0.1, -0.06}};
    foot.place_std = {0.003, 0.003};
    model.feet.push_back(foot);
  }
  return model;
}

inline double swing = 1.0;  // of both angles; 1: as far as shows a memory
inline double push = 0.0;   // rad of pitch, once for two seconds
inline constexpr double PUSHED[2] = {30.0, 32.0};

inline double angle(int axis, double t) {
  const bool pushed = axis == 0 && t > PUSHED[0] && t < PUSHED[1];
  const double more =
      pushed ? push * std::pow(std::sin(std::numbers::pi * (t - PUSHED[0]) / (PUSHED[1] - PUSHED[0])), 2) : 0.0;
  return more +
         swing * (axis == 0 ? 0.02 * std::sin(1.9 * t) + 0.01 * std::sin(5.1 * t) : 0.018 * std::sin(2.3 * t + 1.0));
}
inline double rate(int axis, double t) { return (angle(axis, t + 1e-6) - angle(axis, t - 1e-6)) / 2e-6; }

struct Sensors {
  double position = 0.0, attitude[4], gyroscope[3];
  std::array<double, 6> wrench[2];

  // Ry(pitch) Rx(roll) is the sole in the ankle, and the sole stands flat: its inverse is the ankle in the world.
  explicit Sensors(double t, double delay = 0.0, double load = 300.0) {
    const double p = angle(0, t) / 2, r = angle(1, t) / 2, noise = 1e-9 * std::sin(1e5 * t);
    attitude[0] = std::cos(p) * std::cos(r), attitude[1] = -std::sin(r) * std::cos(p) + noise;
    attitude[2] = -std::cos(r) * std::sin(p), attitude[3] = std::sin(r) * std::sin(p);
    const double dp = rate(0, t), dr = rate(1, t);
    // The ankle turns in the world as the sole turns in the ankle, the other way: -(dp e_y + dr Ry(pitch) e_x).
    gyroscope[0] = -dr * std::cos(2 * p) + noise, gyroscope[1] = -dp, gyroscope[2] = dr * std::sin(2 * p);
    double torque[2];
    for (int a = 0; a < 2; ++a)
      torque[a] = TRUE_STIFFNESS[a] * angle(a, t - delay) + TRUE_DAMPING[a] * rate(a, t - delay) + TRUE_OFFSET[a];
    const double pitch = angle(0, t - delay);
    for (auto& w : wrench) w = {0.0, 0.0, load + 1e-6 * std::sin(1e5 * t), torque[1] / std::cos(pitch), torque[0], 0.0};
  }

  Reading reading(double t) const { return {t, {&position, 1}, {}, attitude, gyroscope, {}, wrench}; }
};

}  // namespace plantar
