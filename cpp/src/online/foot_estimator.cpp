#include "plantar/foot_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "kernels.hpp"
#include "online/attitude_filter.hpp"
#include "online/channel_watch.hpp"
#include "online/contradiction.hpp"
#include "online/delay_watch.hpp"
#include "online/foot_tracker.hpp"

namespace plantar {

namespace {

constexpr double GAP = 0.1;  // s without a sample, at least: what was before is past
constexpr double GAP_PERIODS = 5.0;
constexpr int FIRST_TICKS = 10;       // until the period is known
constexpr double PERIOD_NEWS = 0.05;  // by how much one tick changes the period
constexpr double UNREAD = LARGEST;    // stands for a position that the last tick did not have
constexpr int TICKS = 3;  // columns of the kinematics: this tick, half a period before, and the gyroscope alone

double checked_weight(const EstimatorModel& model) {
  const auto bad = [](const char* what) { throw std::invalid_argument(std::string("model: ") + what); };
  if (!(model.weight > 0.0)) bad("the weight must be positive");
  if (!(model.cutoff > 0.0)) bad("the cutoff must be positive");
  if (!(std::abs(model.wrench_delay) <= LONGEST_DELAY)) bad("the force sensors' delay is longer than 0.1 s");
  if (model.feet.empty()) bad("no feet");
  for (const FootModel& foot : model.feet) {
    if (foot.polygon.size() < 3) bad("a sole needs three corners");
    for (const PathJoint& joint : foot.path)
      if (joint.joint < 0 || joint.joint >= static_cast<int>(model.joints.size())) bad("a joint that is not listed");
  }
  return model.weight;
}

// Of each joint, the one that is as far from another foot: -1 where none is, or both feet share it.
std::vector<int> twins(const EstimatorModel& model) {
  std::vector<int> found(model.joints.size(), -1);
  for (const FootModel& foot : model.feet)
    for (const FootModel& other : model.feet)
      for (std::size_t k = 1; k <= std::min(foot.path.size(), other.path.size()); ++k) {
        const int joint = foot.path[foot.path.size() - k].joint, its = other.path[other.path.size() - k].joint;
        if (joint != its) found[joint] = its;
      }
  return found;
}

}  // namespace

struct FootEstimator::State {
  explicit State(const EstimatorModel& given)
      : model(given),
        weight(checked_weight(given)),
        kernels(**runnable_kernels()),
        weight_watch(weight),
        position(TICKS * given.joints.size()),
        velocity(TICKS * given.joints.size()),
        last_position(given.joints.size()),
        joint_watch(given.joints.size()),
        joint_bad(given.joints.size()),
        joint_dead(given.joints.size()),
        twin(twins(given)),
        wrench_watch(given.feet.size()),
        motion(given.feet.size()),
        bad(given.feet.size()),
        was_bad(given.feet.size(), true),
        estimates(given.feet.size()) {
    for (const FootModel& foot : model.feet) {
      std::vector<ChainStep>& chain = steps.emplace_back();
      for (const PathJoint& joint : foot.path)
        chain.push_back({joint.frame,
                         joint.slides,
                         joint.sign,
                         {position.data() + TICKS * joint.joint, 1},
                         {velocity.data() + TICKS * joint.joint, 1}});
      feet.emplace_back(model, foot);
    }
    for (std::size_t f = 0; f < feet.size(); ++f) estimates[f] = feet[f].estimate();
  }

  void step(const Reading& reading) noexcept;
  enum class Time { onward, still, jumped };
  Time keep_time(double now) noexcept;
  bool imu(const Reading& reading) noexcept;
  void joints(const Reading& reading) noexcept;
  void kinematics(std::size_t foot) noexcept;
  void miss_all(std::uint32_t reason) noexcept;
  void watch_ground() noexcept;
  bool weight_differs(double total) noexcept;

  const EstimatorModel model;
  const double weight;
  const Kernels& kernels;
  WeightWatch weight_watch;
  TurnWatch turn_watch;
  bool turns_differ = false;
  DelayWatch delay_watch;
  std::vector<std::vector<ChainStep>> steps;
  std::vector<FootTracker> feet;
  std::vector<double> position, velocity, last_position;
  std::vector<JointWatch> joint_watch;
  std::vector<std::uint32_t> joint_bad;
  std::vector<bool> joint_dead;
  std::vector<int> twin;
  std::vector<DeviceWatch<6>> wrench_watch;
  DeviceWatch<4> attitude_watch;
  DeviceWatch<3> gyroscope_watch;
  AttitudeFilter filter;
  SlipGate slip;
  bool gyroscope = false;
  double quaternion[4][TICKS] = {}, angular_velocity[3][TICKS] = {};
  double last_quaternion[4] = {1.0, 0.0, 0.0, 0.0}, last_rate[3] = {};
  double out[CHAIN_OUTPUTS][TICKS] = {};
  std::vector<FootKinematics> motion;
  std::vector<std::uint32_t> bad;
  std::vector<bool> was_bad;
  std::vector<FootEstimate> estimates;
  double time = 0.0, dt = 0.0, period = 0.0;
  int ticks = 0;       // since time last jumped
  bool fresh = false;  // the last tick was read
  bool known = false;  // whether a quaternion and positions of an earlier tick are kept
  int next_work = 0;
};

FootEstimator::State::Time FootEstimator::State::keep_time(double now) noexcept {
  if (!(std::abs(now) < LARGEST)) return Time::still;
  const double passed = now - time;
  const bool first = ticks == 0;
  if (!first && passed == 0.0) return Time::still;
  time = now;
  if (first || passed < 0.0 || passed > std::max(GAP, GAP_PERIODS * period)) {
    ticks = 1, known = false;
    slip.restart(), filter.restart(), turn_watch.restart(), weight_watch.restart();
    for (JointWatch& watch : joint_watch) watch.restart();
    return first ? Time::onward : Time::jumped;
  }
  dt = passed;
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
  double dot = 0.0;
  for (int i = 0; i < 4; ++i) q[i] /= length, dot += q[i] * last_quaternion[i];
  const double same = dot < 0.0 ? -1.0 : 1.0;  // q and -q are one attitude
  for (int i = 0; i < 4; ++i) {
    quaternion[i][0] = q[i];
    quaternion[i][1] = known ? q[i] + same * last_quaternion[i] : q[i];
    quaternion[i][2] = q[i];
  }
  if (!gyroscope && known) {  // the turn since the last tick, over its time
    const double* p = last_quaternion;
    const double turn[3] = {p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2],
                            p[0] * q[2] - p[2] * q[0] - p[3] * q[1] + p[1] * q[3],
                            p[0] * q[3] - p[3] * q[0] - p[1] * q[2] + p[2] * q[1]};
    for (int i = 0; i < 3; ++i) w[i] = 2.0 * same * turn[i] / dt;
  }
  for (int i = 0; i < 3; ++i) {
    angular_velocity[i][0] = angular_velocity[i][2] = w[i];
    angular_velocity[i][1] = gyroscope && known ? 0.5 * (w[i] + last_rate[i]) : w[i];
    last_rate[i] = w[i];
  }
  if (!known) turn_watch.restart();
  const TurnWatch::Vector up = {2.0 * (q[1] * q[3] - q[0] * q[2]), 2.0 * (q[2] * q[3] + q[0] * q[1]),
                                1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
  const double turning[3] = {angular_velocity[0][1], angular_velocity[1][1], angular_velocity[2][1]};
  turns_differ = gyroscope && reading.attitude.size() == 4 && dt > 0.0 && turn_watch.differ(up, turning, dt);
  std::copy_n(q, 4, last_quaternion);
  return true;
}

void FootEstimator::State::joints(const Reading& reading) noexcept {
  const std::size_t n = model.joints.size();
  const bool given = reading.velocity.size() == n;
  for (std::size_t j = 0; j < n; ++j) {
    const double q = reading.position[j], v = given ? reading.velocity[j] : 0.0;
    joint_bad[j] = 0;
    if (!all_finite({&q, 1}) || !all_finite({&v, 1})) {
      joint_bad[j] = INPUT_MISSING;
      last_position[j] = UNREAD;
      continue;
    }
    if (joint_watch[j].frozen(q, v, dt)) joint_bad[j] = FROZEN;
    const bool read = known && last_position[j] != UNREAD;
    const double difference = read ? (q - last_position[j]) / dt : 0.0;
    position[TICKS * j] = position[TICKS * j + 2] = q;
    position[TICKS * j + 1] = read ? 0.5 * (q + last_position[j]) : q;
    velocity[TICKS * j] = given ? v : difference, velocity[TICKS * j + 1] = difference;
    last_position[j] = q;
  }
  for (std::size_t j = 0; j < n; ++j) {
    joint_dead[j] = twin[j] >= 0 && joint_watch[j].dead(joint_watch[twin[j]]);
    if (joint_dead[j]) joint_bad[j] |= FROZEN;
  }
}

void FootEstimator::State::kinematics(std::size_t foot) noexcept {
  const Chain chain = {steps[foot].data(), steps[foot].size(), model.feet[foot].bush, model.feet[foot].sole};
  Attitude attitude;
  for (int i = 0; i < 4; ++i) attitude.quaternion[i] = {quaternion[i], 1};
  for (int i = 0; i < 3; ++i) attitude.angular_velocity[i] = {angular_velocity[i], 1};
  double* rows[CHAIN_OUTPUTS];
  for (int r = 0; r < CHAIN_OUTPUTS; ++r) rows[r] = out[r];
  kernels.chain(chain, attitude, 0, TICKS, rows);
  FootKinematics& to = motion[foot];
  for (int i = 0; i < 3; ++i) to.up[i] = out[UP + i][0];
  for (int i = 0; i < 2; ++i) {
    to.angle[i] = out[DEFLECTION + i][0], to.mean_angle[i] = out[DEFLECTION + i][1];
    to.rate[i] = out[RATE + i][0], to.mean_rate[i] = out[RATE + i][1];
    to.turning[i] = out[RATE + i][2];
  }
  to.gyroscope = gyroscope;
  to.place = {out[SOLE_POSITION][0], out[SOLE_POSITION + 1][0], out[HEADING][0]};
}

void FootEstimator::State::miss_all(std::uint32_t reason) noexcept {
  for (std::size_t f = 0; f < feet.size(); ++f) {
    feet[f].miss(reason);
    was_bad[f] = true;
    estimates[f] = feet[f].estimate();
  }
  known = false;
  slip.restart();
}

// Feet that step onto other ground one after the other say the same. Where all stand, one lean of the attitude shows in
// all of them.
void FootEstimator::State::watch_ground() noexcept {
  std::array<double, 2> all = {};
  bool steps = false;
  for (const FootTracker& foot : feet) steps = steps || foot.contact() == ContactState::air;
  if (!steps) return;
  for (const FootTracker& foot : feet)
    for (int side = 0; side < 2; ++side) all[side] += foot.suspicion()[side];
  if (std::max(all[0], all[1]) < SURE_OF_CHANGE) return;
  for (FootTracker& foot : feet) foot.change_ground();
}

// Where no foot stands, or one cannot be read, the weight is not known to rest on them.
bool FootEstimator::State::weight_differs(double total) noexcept {
  int unknown = 0;
  bool stands = false, read = true;
  for (std::size_t f = 0; f < feet.size(); ++f) {
    read = read && !bad[f] && !model.feet[f].always;
    stands = stands || feet[f].contact() == ContactState::stance;
    unknown += !feet[f].zero_known();
  }
  if (read && stands) return weight_watch.differs(total, unknown, dt);
  weight_watch.restart();
  return false;
}

void FootEstimator::State::step(const Reading& reading) noexcept {
  const Time went = keep_time(reading.time);
  if (went == Time::jumped) return miss_all(TIME_FAULT);
  if (went == Time::still) {  // the same tick again, or none: nothing happens
    for (FootEstimate& estimate : estimates) estimate.flags |= TIME_FAULT;
    return;
  }
  const bool shaped =
      reading.position.size() == model.joints.size() && reading.wrench.size() == feet.size() &&
      (reading.attitude.size() == 4 || (reading.angular_velocity.size() == 3 && reading.acceleration.size() == 3));
  if (!shaped || !all_finite(reading.attitude) || !all_finite(reading.angular_velocity) ||
      (reading.attitude.empty() && !all_finite(reading.acceleration)))
    return miss_all(INPUT_MISSING);
  const bool frozen = (reading.attitude.size() == 4 && attitude_watch.frozen(reading.attitude, dt)) ||
                      (reading.angular_velocity.size() == 3 && gyroscope_watch.frozen(reading.angular_velocity, dt));
  joints(reading);
  if (!imu(reading)) return miss_all(INPUT_MISSING);
  double total = 0.0;
  for (std::size_t f = 0; f < feet.size(); ++f) {
    bad[f] = frozen ? FROZEN : 0u;
    if (!all_finite(reading.wrench[f]))
      bad[f] |= INPUT_MISSING;
    else if (wrench_watch[f].frozen(reading.wrench[f], dt))
      bad[f] |= FROZEN;
    for (const PathJoint& joint : model.feet[f].path) {
      bad[f] |= joint_bad[joint.joint];
      if (joint_dead[joint.joint]) feet[f].forget();
      if (!joint.slides && std::abs(reading.position[joint.joint]) > WHOLE_TURN) bad[f] |= INPUT_MISSING;
    }
    if (bad[f] & INPUT_MISSING) continue;
    kinematics(f);
    feet[f].read(motion[f], reading.wrench[f]);
    total += feet[f].load();
  }
  SlipGate::Verdict slips = SlipGate::Verdict::none;
  const bool both = feet.size() == 2 && !bad[0] && !bad[1] && feet[0].contact() == ContactState::stance &&
                    feet[1].contact() == ContactState::stance;
  if (both)
    slips = slip.step(motion[0].place, motion[1].place, std::max(dt, 1e-9));
  else
    slip.restart();
  const bool contradiction = weight_differs(total) || turns_differ;
  Lateness all;
  for (const FootTracker& foot : feet) all += foot.lateness();
  const bool late = delay_watch.late(all, model.wrench_delay_std, period);
  for (std::size_t f = 0; f < feet.size(); ++f) {
    if (bad[f]) {
      feet[f].miss(bad[f]);
    } else {
      const bool begun = known && !was_bad[f] && ticks > FIRST_TICKS;
      feet[f].learn(motion[f], total - feet[f].load(), {slips, contradiction, late}, begun, time, dt, period);
    }
    was_bad[f] = bad[f] != 0;
  }
  known = true;
  watch_ground();
  feet[next_work / FootTracker::PIECES].work(next_work % FootTracker::PIECES);
  next_work = (next_work + 1) % (FootTracker::PIECES * static_cast<int>(feet.size()));
  for (std::size_t f = 0; f < feet.size(); ++f) estimates[f] = feet[f].estimate();
}

FootEstimator::FootEstimator(const EstimatorModel& model) : state_(std::make_unique<State>(model)) {}
FootEstimator::~FootEstimator() = default;
FootEstimator::FootEstimator(FootEstimator&&) noexcept = default;
FootEstimator& FootEstimator::operator=(FootEstimator&&) noexcept = default;

std::span<const FootEstimate> FootEstimator::step(const Reading& reading) noexcept {
  state_->step(reading);
  return state_->estimates;
}

}  // namespace plantar
