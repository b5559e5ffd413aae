// A sole that tips before its centre of pressure seems to be at the edge: a zero of the torque moves the one, not the
// other. The foot then turns on while the torque that would bend the bush stays as it is.
#pragma once

#include <array>
#include <cmath>

#include "online/one_pole.hpp"

namespace plantar {

constexpr double EDGE_MARGIN = 0.005;  // m from the sole's border
constexpr double TORQUE_ZERO = 6e-3;   // m, times the weight: how far a torque's zero may be off, three usual ones
constexpr double ZERO_SHARE = 0.125;   // of half the sole's width, at most: or a small sole's middle would be its edge
constexpr double LEAST_LEAN = 0.003;   // rad: less hardly disturbs a deflection, as in `identify feet`
constexpr double LEAN_BAND = 20.0;     // Hz: noise above it is no lean
constexpr double SOFTER_BUSH = 0.5;    // of the bend that the torque explains: no softer ground looks like a lean

class EdgeWatch {
 public:
  // weight [N]; half_width: of the middle of the sole inside its outline [m].
  EdgeWatch(double weight, double half_width) noexcept
      : zero_(std::fmin(TORQUE_ZERO, ZERO_SHARE * half_width) * weight) {}

  void restart() noexcept { first_ = true, visiting_ = false; }

  // Whether the sole leans on its edge. inside: of the centre of pressure in the sole's outline [m]; load [N]; angle:
  // of the ankle over the ground; bent: what the torque explains of it [rad].
  bool step(double inside, double load, const std::array<double, 2>& angle, const std::array<double, 2>& bent,
            double dt) noexcept {
    const double blend = first_ ? 1.0 : followed_in_band(LEAN_BAND, dt);
    first_ = false;
    for (int a = 0; a < 2; ++a) {
      angle_[a] += blend * (angle[a] - angle_[a]);
      bent_[a] += blend * (bent[a] - bent_[a]);
    }
    const bool near = inside * load < EDGE_MARGIN * load + zero_;
    if (!near || !visiting_) flat_angle_ = angle_, flat_bent_ = bent_;
    visiting_ = near;
    std::array<double, 2> explained, beyond;
    for (int a = 0; a < 2; ++a) {
      explained[a] = bent_[a] - flat_bent_[a];
      beyond[a] = angle_[a] - flat_angle_[a] - explained[a];
    }
    return length(beyond) > LEAST_LEAN + SOFTER_BUSH * length(explained);
  }

 private:
  static double length(const std::array<double, 2>& plane) noexcept {
    return std::sqrt(plane[0] * plane[0] + plane[1] * plane[1]);
  }

  double zero_;  // N·m
  bool first_ = true, visiting_ = false;
  std::array<double, 2> angle_ = {}, bent_ = {};            // behind the band
  std::array<double, 2> flat_angle_ = {}, flat_bent_ = {};  // when the sole was flat last
};

}  // namespace plantar
