// The state of a Jenkins element, from -1 to 1, as far as it is known: the lowest and the highest that it can be.
//
// On the ground the state follows the deflection. A foot that lifts does not come to rest where it began: the element
// holds on, and leaves the unloaded spring bent the other way. From there the next step loads it.
#pragma once

#include <algorithm>
#include <cmath>

namespace plantar {

constexpr double LEAN = 0.005;  // rad: how far an attitude may lean, two deviations of a usual one

// Between two samples an angle may turn round: the element has gone as far as it, and the samples have not. An angle is
// the mean of both ends of its period, and so an eighth of its curvature nearer than the middle.
inline bool turned(double rate_before, double rate) noexcept { return rate_before * rate < 0.0; }
inline double turning_angle(double before, double rate_before, double rate, double dt) noexcept {
  const double bends = rate - rate_before;
  return before - (bends / 8.0 + rate_before * rate_before / (2.0 * bends)) * dt;
}

class ElementState {
 public:
  double state() const noexcept { return 0.5 * (low_.state + high_.state); }
  // How far from its state it may be: half the way between both bounds.
  double gap() const noexcept { return 0.5 * (high_.state - low_.state); }

  // Nothing is known of it but its slip angle and the bush's `angle` [rad].
  void begin(double slip, double angle) noexcept {
    slip_ = slip, in_slips_ = 1.0 / slip, low_ = {-1.0, angle}, high_ = {1.0, angle};
  }
  // The bush on the ground is bent to `angle` [rad].
  void load(double angle) noexcept { low_.bend(angle, in_slips_), high_.bend(angle, in_slips_); }
  // The same from one period's mean of both ends to the next one's; then the state is that of both ends, too.
  void follow(double angle) noexcept { low_.follow(angle, in_slips_), high_.follow(angle, in_slips_); }
  // The sole has turned with the ankle for a while, the bush hardly. It is at `angle` now.
  void hold(double angle) noexcept {
    low_.angle = high_.angle = angle;
    widen(LEAN / slip_);
  }
  // The bush is unloaded; `pull` [rad] is slip torque over stiffness, by which an element that slips leaves it bent.
  void unload(double pull) noexcept {
    low_.unload(pull, slip_), high_.unload(pull, slip_);
    widen(LEAN / (slip_ + pull));
  }

 private:
  struct Bound {
    double state = 0.0, angle = 0.0;

    // in_slips: one over the slip angle.
    void bend(double to, double in_slips) noexcept {
      state = std::clamp(state + (to - angle) * in_slips, -1.0, 1.0);
      angle = to;
    }
    // The end of the last period is half a step on. Where it slips within this one, it has that end's way left to slip,
    // and in the mean of both ends half of it.
    void follow(double to, double in_slips) noexcept {
      const double step = (to - angle) * in_slips, half = 0.5 * std::abs(step), beyond = std::abs(state + step) - 1.0;
      bend(to, in_slips);
      if (beyond > -half) state = std::copysign(1.0 - 0.5 * std::max(half - beyond, 0.0), step);
    }
    // No torque: angle + pull·state = 0, with a state that sticks on the way or slips.
    void unload(double pull, double slip) noexcept {
      const double sticks = pull * (angle - slip * state) / (slip + pull);
      const double reached = state + (sticks - angle) / slip;
      if (std::abs(reached) <= 1.0)
        state = reached, angle = sticks;
      else
        state = std::clamp(reached, -1.0, 1.0), angle = -pull * state;
    }
  };
  void widen(double by) noexcept {
    low_.state = std::max(low_.state - by, -1.0), high_.state = std::min(high_.state + by, 1.0);
  }

  double slip_ = 1.0, in_slips_ = 1.0;
  Bound low_, high_;
};

}  // namespace plantar
