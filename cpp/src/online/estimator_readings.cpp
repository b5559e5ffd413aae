// One tick's readings, before anything is learnt from them: time, IMU, joints, and where they put each foot.
#include <algorithm>
#include <cmath>

#include "online/estimator_state.hpp"

namespace plantar {

namespace {

constexpr double GAP = 0.1;  // s without a sample, at least: what was before is past
constexpr double GAP_PERIODS = 5.0;
constexpr double CLOCK_STEADY = 5.0;  // s without a jump: one that comes later is another recording, not a clock's fault
constexpr double CLOCK_DOUBT = 0.9;   // s behind one that comes sooner, in which nothing is learnt
constexpr double PERIOD_NEWS = 0.05;  // by how much one tick changes the period
constexpr double UNREAD = LARGEST;    // stands for a position that the last tick did not have

}  // namespace

FootEstimator::State::Time FootEstimator::State::keep_time(double now) noexcept {
  if (!(std::abs(now) < LARGEST)) return Time::still;
  const double passed = now - time;
  const bool first = ticks == 0;
  if (!first && passed == 0.0) return Time::still;
  time = now;
  if (first || passed < 0.0 || passed > std::max(GAP, GAP_PERIODS * period)) {
    clock_doubt = first || steady > CLOCK_STEADY ? 0.0 : CLOCK_DOUBT;
    ticks = 1, known = false, steady = 0.0;
    slip.restart(), filter.restart(), turn_watch.restart(), weight_watch.restart();
    for (const int j : moving) joint_watch[j].restart();
    return first ? Time::onward : Time::jumped;
  }
  dt = passed, steady += dt, clock_doubt = std::max(clock_doubt - dt, 0.0);
  period = ticks == 1 ? dt : period + PERIOD_NEWS * (dt - period);
  ++ticks;
  return Time::onward;
}

bool FootEstimator::State::imu(const Reading& reading) noexcept {
  gyroscope = reading.angular_velocity.size() == 3;
  double q[4], w[3] = {0.0, 0.0, 0.0};
  if (gyroscope) std::copy_n(reading.angular_velocity.data(), 3, w);
  if (reading.attitude.size() == 4) {
    std::copy_n(reading.attitude.data(), 4, q);
  } else {
    double mean[3];
    for (int i = 0; i < 3; ++i) mean[i] = known ? 0.5 * (w[i] + last_rate[i]) : w[i];
    const AttitudeFilter::Quaternion& found = filter.step(mean, reading.acceleration.data(), dt);
    std::copy(found.begin(), found.end(), q);
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0.0)) return false;
  const double scale = 1.0 / length;
  double dot = 0.0;
  for (int i = 0; i < 4; ++i) q[i] *= scale, dot += q[i] * last_quaternion[i];
  const double same = dot < 0.0 ? -1.0 : 1.0;  // q and -q are one attitude
  for (int i = 0; i < 4; ++i) {
    paths.set_attitude(i, {q[i], known ? q[i] + same * last_quaternion[i] : q[i]});
  }
  if (!gyroscope && known) {  // the turn since the last tick, over its time
    const double* p = last_quaternion;
    const double turn[3] = {p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2],
                            p[0] * q[2] - p[2] * q[0] - p[3] * q[1] + p[1] * q[3],
                            p[0] * q[3] - p[3] * q[0] - p[1] * q[2] + p[2] * q[1]};
    for (int i = 0; i < 3; ++i) w[i] = 2.0 * same * turn[i] / dt;
  }
  double turning[3];  // in the middle of the period
  for (int i = 0; i < 3; ++i) {
    turning[i] = gyroscope && known ? 0.5 * (w[i] + last_rate[i]) : w[i];
    paths.set_angular_velocity(i, {w[i], turning[i]});
    last_rate[i] = w[i];
  }
  if (!known) turn_watch.restart();
  const TurnWatch::Vector up = {2.0 * (q[1] * q[3] - q[0] * q[2]), 2.0 * (q[2] * q[3] + q[0] * q[1]),
                                1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
  turns_differ = gyroscope && reading.attitude.size() == 4 && dt > 0.0 && turn_watch.differ(up, turning, dt);
  std::copy_n(q, 4, last_quaternion);
  return true;
}

void FootEstimator::State::joints(const Reading& reading) noexcept {
  const bool given = reading.velocity.size() == model.joints.size();
  const double rate = known ? 1.0 / dt : 0.0;  // ticks in a second
  for (const int j : moving) {
    const double q = reading.position[j], v = given ? reading.velocity[j] : 0.0;
    joint_bad[j] = 0;
    if (!all_finite({&q, 1}) || !all_finite({&v, 1})) {
      joint_bad[j] = INPUT_MISSING;
      last_position[j] = UNREAD;
      continue;
    }
    if (joint_watch[j].frozen(q, v, dt)) joint_bad[j] = FROZEN;
    const bool read = known && last_position[j] != UNREAD;
    const double difference = read ? (q - last_position[j]) * rate : 0.0;
    paths.set(j, {q, read ? 0.5 * (q + last_position[j]) : q}, {given ? v : difference, difference});
    last_position[j] = q;
  }
  for (const FootModel& foot : model.feet) {
    double leg = 0.0;
    for (const PathJoint& joint : foot.path)
      if (twin[joint.joint] >= 0) leg += joint_watch[joint.joint].moved();
    for (const PathJoint& joint : foot.path) {
      const int j = joint.joint;
      if (twin[j] < 0) continue;
      joint_dead[j] = joint_watch[j].dead(joint_watch[twin[j]]);
      if (joint_watch[j].stuck(joint_watch[twin[j]], leg) || joint_dead[j]) joint_bad[j] |= FROZEN;
    }
  }
}

}  // namespace plantar
