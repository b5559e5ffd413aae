// What readings that are later than was told do: torques to stiffness and damping, an IMU to what the body's turning
// explains.
#include <cmath>
#include <numbers>
#include <random>

#include "check.hpp"
#include "online/axis_regression.hpp"

namespace late_torque_test {

using namespace plantar;

constexpr double ROW = 0.025, DAMPING_TRUTH = 20.0;  // s, N·m·s/rad

// What a later torque does is told before: beside an element that hardly slips C loses more than K times the delay.
void what_a_delay_does_is_known_beforehand() {
  constexpr double LATER = 1e-3, SLIP = 0.02, ELEMENT = 6.0;  // s, rad, N·m
  const RegressionPrior prior = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                                 {}, {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, ROW};
  AxisRegression on_time(prior), late(prior);
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int i = 0; i < 2400; ++i) {
    const double t = ROW * i, a = 0.01 * std::sin(2.0 * t), b = 0.005 * std::sin(5.0 * t);
    const double state = std::sin((a + b) / SLIP);
    const double rate = 0.02 * std::cos(2.0 * t) + 0.025 * std::cos(5.0 * t);
    const double stiff = 800.0 + ELEMENT / SLIP * std::cos((a + b) / SLIP);
    const double changes = stiff * rate - DAMPING_TRUTH * (4.0 * a + 25.0 * b);
    RegressionRow row = {{1.0, t}, {a + b, rate, state, 0.0, 0.0, 0.0, -changes}, 0.0, {}};
    row.torque = 800.0 * (a + b) + DAMPING_TRUTH * rate + ELEMENT * state + noise(random);
    on_time.add(row, ROW), on_time.work();
    row.torque -= LATER * changes;
    late.add(row, ROW), late.work();
  }
  for (int i = 0; i < 4; ++i) on_time.work(), late.work();
  const auto &then = late.values(), &now = on_time.values();
  for (const Unknown one : {STIFFNESS, DAMPING})
    check::near(then.value[one] - now.value[one], LATER * now.by_late[one], 1e-5 * std::abs(now.by_late[one]), "a delay");
  check::that(-now.by_late[DAMPING] > 800.0 + 0.8 * ELEMENT / SLIP, "the element's stiffness takes its part");
}

// An IMU behind the encoders lacks what the body has turned since; where the joints stand, no row can say so.
void an_imu_behind_the_encoders_is_told_by_the_turning(double later, bool joints_move) {
  constexpr double STIFF = 800.0;
  const RegressionPrior prior = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                                 {}, {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, ROW};
  AxisRegression axis(prior);
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (int i = 0; i < 2400; ++i) {
    const double t = ROW * i, angle = 0.01 * std::sin(2.0 * t), rate = 0.02 * std::cos(2.0 * t);
    const double turning = joints_move ? 0.02 * std::cos(3.1 * t) : rate;
    RegressionRow row = {{1.0, t}, {angle - later * turning, rate, 0.0, 0.0, 0.0, 0.0, 0.0, turning}, 0.0, {}};
    row.torque = STIFF * angle + DAMPING_TRUTH * rate + noise(random);
    axis.add(row, ROW), axis.work();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  const Untold found = axis.values().turned;
  if (!joints_move) return check::that(found.grouped == 0.0, "joints that stand tell nothing");
  check::near(found.value / STIFF, later, 3e-4, "how late the IMU is");
  check::that(std::abs(found.value - STIFF * later) < 3.0 * std::max(found.grouped, found.white), "and how surely");
}

// Encoders' noise differs from the angle's in the turning's column, too. It tells nothing up to eight times of what the
// angle's noise would be as a rate's: a third of the squared edge of what rows can hold.
void noise_in_the_turning_tells_no_delay() {
  constexpr double NOISE = 1e-5;  // rad
  const RegressionPrior prior = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                                 {}, {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, ROW};
  const double edge = std::numbers::pi / ROW;
  for (const double times : {6.0, 11.0}) {
    AxisRegression axis(prior);
    std::mt19937 random(10);
    std::normal_distribution<double> noise(0.0, NOISE * edge * std::sqrt(times / 3.0));
    for (int i = 0; i < 2400; ++i) {
      const double t = ROW * i, angle = 0.01 * std::sin(2.0 * t), rate = 0.02 * std::cos(2.0 * t);
      RegressionRow row = {{1.0, t}, {angle, rate, 0.0, 0.0, 0.0, 0.0, 0.0, rate + noise(random)}, 0.0, {NOISE * NOISE}};
      row.torque = 800.0 * angle + DAMPING_TRUTH * rate + 0.01 * std::sin(1e5 * i);
      axis.add(row, ROW), axis.work();
    }
    for (int i = 0; i < 4; ++i) axis.work();
    check::that((axis.values().turned.grouped > 0.0) == (times > 8.0), "a turning that is no more than noise");
  }
}

void run() {
  noise_in_the_turning_tells_no_delay();
  what_a_delay_does_is_known_beforehand();
  for (const double later : {0.0, 0.01, -0.01}) an_imu_behind_the_encoders_is_told_by_the_turning(later, true);
  an_imu_behind_the_encoders_is_told_by_the_turning(0.01, false);
}

const check::Listed listed(run);

}  // namespace late_torque_test
