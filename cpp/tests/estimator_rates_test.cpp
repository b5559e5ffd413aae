// Rates that are differences of joint angles, beside torques and angles that are read at the ticks.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "check.hpp"
#include "two_feet.hpp"

namespace estimator_rates_test {

using namespace plantar;

constexpr double LEAN[2] = {0.03, 0.004}, QUICK[2] = {0.6, 3.0};  // rad and Hz of two swings in pitch

double bent(double t) {
  double sum = 0.0;
  for (int i = 0; i < 2; ++i) sum += LEAN[i] * std::sin(2 * std::numbers::pi * QUICK[i] * t + i);
  return sum;
}
double bends(double t) { return (bent(t + 1e-6) - bent(t - 1e-6)) / 2e-6; }

// The body stands still over an ankle that turns about y by as much as the sole turns the other way.
EstimatorModel ankles() {
  EstimatorModel model = two_feet();
  for (FootModel& foot : model.feet) foot.path = {{0, false, 1.0, {{1, 0, 0, 0, 0, 1, 0, -1, 0}, {0, 0, 0}}}};
  for (FootModel& foot : model.feet) foot.bush = {{1, 0, 0, 0, 0, -1, 0, 1, 0}, {0, 0, 0}};
  return model;
}

// Slow logs show a swing of 3 Hz by seven samples and fewer: its differences are 2 % less than its rates.
void a_joint_turns(double rate_hz) {
  FootEstimator estimator(ankles());
  FootEstimate last;
  for (int i = 0; i < static_cast<int>(40 * rate_hz); ++i) {
    const double t = i / rate_hz, noise = 1e-9 * std::sin(1e5 * t);
    const std::array<double, 4> level = {1.0, noise, 0.0, 0.0};
    const std::array<double, 3> still = {noise, 0.0, 0.0};
    const double joint = -bent(t), torque = TRUE_STIFFNESS[0] * bent(t) + TRUE_DAMPING[0] * bends(t) + TRUE_OFFSET[0];
    std::array<std::array<double, 6>, 2> wrench;
    wrench.fill({0.0, 0.0, 300.0 + 1e-6 * std::sin(1e5 * t), 0.0, torque, 0.0});
    last = estimator.step({t, {&joint, 1}, {}, level, still, {}, wrench})[0];
    check::near(last.pitch.deflection, bent(t), 1e-8, "deflection of this tick");
  }
  check::near(last.pitch.stiffness.value, TRUE_STIFFNESS[0], 1e-3 * TRUE_STIFFNESS[0], "stiffness");
  check::near(last.pitch.damping.value, TRUE_DAMPING[0], 2e-3 * TRUE_DAMPING[0], "damping");
}

// A leg that stands still beside one that moves is no fault; a chest that turns over both is no motion of that leg.
void a_waist_is_no_part_of_a_leg(bool knee_moves) {
  EstimatorModel model = two_feet();
  model.joints = {"waist", "left_knee", "left", "right_knee", "right"};
  for (int foot = 0; foot < 2; ++foot)
    model.feet[foot].path = {{0, false, 1.0, HERE}, {1 + 2 * foot, false, 1.0, HERE}, {2 + 2 * foot, false, 1.0, HERE}};
  FootEstimator estimator(model);
  bool frozen = false;
  for (int i = 0; i < 1800; ++i) {
    const double t = i / 200.0, stood = std::min(t, 5.0);
    const double moves = 0.2 * std::sin(2.0 * t), stands = 0.2 * std::sin(2.0 * stood);
    const std::array<double, 5> joints = {0.3 * std::sin(t), knee_moves ? moves : stands, stands, moves, moves};
    Sensors sensors(t);
    Reading reading = sensors.reading(t);
    reading.position = joints;
    frozen = frozen || (estimator.step(reading)[0].flags & FROZEN);
  }
  check::that(frozen == knee_moves, "an ankle that stands while its own leg and its twin move");
}

void run() {
  for (const bool knee_moves : {false, true}) a_waist_is_no_part_of_a_leg(knee_moves);
  for (const double rate_hz : {50.0, 200.0, 1000.0}) a_joint_turns(rate_hz);
}

const check::Listed listed(run);

}  // namespace estimator_rates_test
