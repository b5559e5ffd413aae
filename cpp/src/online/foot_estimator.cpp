#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "online/estimator_state.hpp"

namespace plantar {

namespace {

constexpr int FIRST_TICKS = 10;  // until the period is known

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

std::vector<int> on_paths(const EstimatorModel& model) {
  std::vector<int> found;
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j)
    for (const FootModel& foot : model.feet)
      if (std::ranges::any_of(foot.path, [j](const PathJoint& joint) { return joint.joint == j; })) {
        found.push_back(j);
        break;
      }
  return found;
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

FootEstimator::State::State(const EstimatorModel& given)
    : model(given),
      weight(checked_weight(given)),
      weight_watch(weight),
      foot_delay_watch(given.feet.size()),
      paths(given, **runnable_kernels()),
      moving(on_paths(given)),
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
  for (const FootModel& foot : model.feet) feet.emplace_back(model, foot);
  for (std::size_t f = 0; f < feet.size(); ++f) estimates[f] = feet[f].estimate();
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

bool FootEstimator::State::encoder_doubtful(std::size_t foot) const noexcept {
  return std::ranges::any_of(model.feet[foot].path,
                             [this](const PathJoint& joint) { return joint_watch[joint.joint].doubtful(); });
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
  paths.run();
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
      if (joint_watch[joint.joint].leapt()) feet[f].lose_elements();
      if (!joint.slides && std::abs(reading.position[joint.joint]) > WHOLE_TURN) bad[f] |= INPUT_MISSING;
    }
    if (bad[f] & INPUT_MISSING) continue;
    paths.read(f, motion[f]);
    motion[f].gyroscope = gyroscope;
    feet[f].read(motion[f], reading.wrench[f], reading.position);
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
  // Before the delays are watched: what it finds late is not believed for a tick.
  feet[next_work / FootTracker::PIECES].work(next_work % FootTracker::PIECES);
  next_work = (next_work + 1) % (FootTracker::PIECES * static_cast<int>(feet.size()));
  Lateness all, imu;
  for (const FootTracker& foot : feet) all += foot.lateness(), imu += foot.imu_lateness();
  const bool all_late = delay_watch.late(all, model.wrench_delay_std, period);
  const bool late_imu = imu_watch.late(imu, 0.0, period);
  for (std::size_t f = 0; f < feet.size(); ++f) {
    if (bad[f]) {
      feet[f].miss(bad[f]);
    } else {
      const bool begun = known && !was_bad[f] && ticks > FIRST_TICKS;
      const bool late = foot_delay_watch[f].late(feet[f].lateness(), model.wrench_delay_std, period) || all_late;
      const bool still = encoder_doubtful(f) || clock_doubt > 0.0;
      feet[f].learn(motion[f], total - feet[f].load(),
                    {slips, contradiction, late, late_imu, still}, begun, time, dt, period);
    }
    was_bad[f] = bad[f] != 0;
  }
  known = true;
  watch_ground();
  for (std::size_t f = 0; f < feet.size(); ++f) {
    estimates[f] = feet[f].estimate();
    if (clock_doubt > 0.0) estimates[f].flags |= TIME_FAULT;
  }
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
