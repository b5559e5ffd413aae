#include "online/foot_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plantar {

namespace {

constexpr double LEAST_LOAD = 0.02;     // of the weight: a foot that carries less has no centre of pressure
constexpr double ROLLING_SHARE = 0.1;   // of the sole's half width: a sole that lands may roll so near its outline
constexpr double LONGEST_STANCE = 5.0;  // s: a foot that stands longer does not step now
constexpr double LONGEST_SHOCK = 0.04;  // s, in all, as in `identify feet`
constexpr int STEPS = 3;                // stances, from which a foot counts as one that steps
constexpr double USUAL_ANGLE = 0.01;    // rad, rad/s: what columns are scaled by
constexpr double USUAL_RATE = 0.1;
constexpr double USUAL_SLOPE = 0.1;  // horizontal force over weight
constexpr double SLOWEST = 1.0;      // s: damping over stiffness before any data
constexpr double TWIST_ZERO = 2e-3;  // m, times the weight: zero of a yaw torque
constexpr double NEVER = 1e-9;       // s: the values follow the delays that were told
constexpr double STEEPEST = 0.35;    // rad: no sole lies so on a ground that a robot stands on
constexpr double FASTEST = 20.0;     // rad/s: no bush is bent so fast
constexpr double CHANGE_TOLD = 5.0;  // s for which the flag of a change stands
constexpr std::uint32_t OF_LEARNING = NEVER_LOADED | PITCH_UNKNOWN | ROLL_UNKNOWN | PITCH_MEMORY | ROLL_MEMORY |
                                      PITCH_UNTESTED | ROLL_UNTESTED;  // they outlast a tick

RegressionPrior prior_of(const EstimatorModel& model, const FootModel& foot, int axis, double slip) noexcept {
  const double w = model.weight;
  const bool known = has_element(foot, axis);
  const double torque_std = known && foot.slip_torque_std[axis] > 0.0 ? foot.slip_torque_std[axis] : w;
  RegressionPrior prior;
  prior.scale = {USUAL_ANGLE,     USUAL_RATE, 1.0, w, USUAL_SLOPE * w, USUAL_SLOPE * w * w,
                 USUAL_SLOPE * w, USUAL_RATE};
  prior.mean = {};
  if (known) prior.mean[SLIP_TORQUE] = foot.slip_torque[axis];
  prior.spread = {STIFFEST * w,
                  SLOWEST * STIFFEST * w,
                  torque_std,
                  std::max(foot.place_std[0], 1e-9),
                  std::max(foot.place_std[1], 1e-9),
                  std::max(foot.compliance_std, 1e-9 / w),
                  NEVER,
                  NEVER * w};
  prior.twist = axis == 1 ? TWIST_ZERO * w : 0.0;
  prior.element_slope = slip > 0.0 ? 1.0 / slip : 0.0;
  prior.element_share = smooth_share(model.cutoff), prior.element_lag = smooth_lag(model.cutoff);
  prior.load_arm = (axis == 0 ? -foot.sensor.origin[0] : foot.sensor.origin[1]) - foot.misplaced[axis].aside;
  prior.horizontal_arm = foot.sensor.origin[2] - foot.misplaced[axis].above;
  prior.noise_time = 0.5 / model.cutoff;
  return prior;
}

}  // namespace

FootTracker::FootTracker(const EstimatorModel& model, const FootModel& foot)
    : foot_(&foot),
      joints_(foot),
      weight_(model.weight),
      least_load_(LEAST_LOAD * model.weight),
      outline_(foot.polygon),
      middle_depth_(outline_.middle_depth()),
      delay_(model.wrench_delay),
      cutoff_(model.cutoff),
      noise_(model.cutoff),
      gain_std_(model.wrench_gain_std),
      delay_std_(model.wrench_delay_std),
      gate_(model.weight, foot.always),
      shaking_(model.weight),
      edge_(model.weight, middle_depth_),
      axes_{AxisRegression(prior_of(model, foot, 0, foot.slip_angle[0])),
            AxisRegression(prior_of(model, foot, 1, foot.slip_angle[1]))},
      memories_{MemoryWatch(prior_of(model, foot, 0, SUSPECTED_ANGLE)),
                MemoryWatch(prior_of(model, foot, 1, SUSPECTED_ANGLE))} {
  for (int axis = 0; axis < 2; ++axis) {
    slip_angle_[axis] = has_element(foot, axis) ? foot.slip_angle[axis] : SUSPECTED_ANGLE;
    publish(axis);
  }
  estimate_.flags = NOT_STANDING | NEVER_LOADED | PITCH_UNKNOWN | ROLL_UNKNOWN;
}

void FootTracker::read(const FootKinematics& motion, const std::array<double, 6>& raw,
                       std::span<const double> position) noexcept {
  raw_ = raw;
  std::array<double, 6> zeroed;
  for (int i = 0; i < 6; ++i) zeroed[i] = raw[i] - zero_.value()[i];
  wrench_ = moved_wrench(foot_->sensor, foot_->sign, zeroed.data());
  const Bend bend(motion.up);
  estimate_.load = motion.up[0] * wrench_[0] + motion.up[1] * wrench_[1] + motion.up[2] * wrench_[2];
  bends_ = joints_.more(motion.up, wrench_, position);
  estimate_.pitch.deflection = motion.angle[0] + bends_[0];
  estimate_.roll.deflection = motion.angle[1] + bends_[1];
  estimate_.pitch.rate = motion.rate[0], estimate_.roll.rate = motion.rate[1];
  // The loaded slide carries the bush's centre up by z. The roll axis turns with the pitch: Ry(pitch) e_x.
  const double z = foot_->compliance * wrench_[2];
  estimate_.compression = estimate_.compliance.value * wrench_[2];
  const double about_pitch = wrench_[4] - z * wrench_[0];
  const double about_roll = bend.cos_pitch * (wrench_[3] + z * wrench_[1]) - bend.sin_pitch * wrench_[5];
  const auto& [of_pitch, of_roll] = foot_->misplaced;
  const auto told = [&](const Misplaced& is, double across, double other) {
    return is.aside * wrench_[2] + is.above * across + is.turned * other + is.leans * wrench_[5];
  };
  estimate_.pitch.torque = about_pitch - told(of_pitch, wrench_[0], about_roll);
  estimate_.roll.torque = about_roll - told(of_roll, -wrench_[1], about_pitch);
  Point centre;
  if (centre_of_pressure(wrench_, bend, foot_->sole, least_load_, centre)) estimate_.centre_of_pressure = centre;
}

void FootTracker::close_blocks() noexcept {
  for (AxisRegression& axis : axes_) axis.close();
  for (MemoryWatch& memory : memories_) memory.close();
}

void FootTracker::end_stance() noexcept {
  close_blocks();
  held_count_ = 0;
  if (gate_.stances() != STEPS) return;
  for (AxisRegression& axis : axes_) axis.set_spread(ASIDE, STIFFEST);
  for (MemoryWatch& memory : memories_) memory.set_spread(ASIDE, STIFFEST);
}

void FootTracker::learn(const FootKinematics& motion, double others, Doubt doubt, bool fresh, double time, double dt,
                        double period) noexcept {
  period_ = period;
  noise_.follow({{motion.angle[0], motion.angle[1]},
                 {motion.turning[0], motion.turning[1]},
                 {estimate_.load, wrench_[0], wrench_[1]},
                 motion.gyroscope},
                dt, period);
  const ContactState before = gate_.contact();
  const double inside = outline_.depth(estimate_.centre_of_pressure);
  const bool carries = estimate_.load > least_load_;
  const bool steep = std::max(std::abs(motion.angle[0]), std::abs(motion.angle[1])) > STEEPEST ||
                     std::max(std::abs(motion.rate[0]), std::abs(motion.rate[1])) > FASTEST;
  flat_ = carries && !steep && inside > ROLLING_SHARE * middle_depth_;
  if (steep && !foot_->always) gate_.restart();
  const ContactState contact = gate_.step(estimate_.load, others, flat_, zero_.known(), dt);
  const bool struck = shaking_.step(wrench_.data(), dt) && !foot_->always && gate_.standing_for() > LONGEST_STANCE;
  if (contact == ContactState::air) zero_.swing(raw_, estimate_.load, weight_, dt);
  if (before == ContactState::air && contact != ContactState::air) zero_.landed();
  if (before == ContactState::stance && contact != ContactState::stance) {
    commit(std::min(time - gate_.settling(), inside_until_));
    end_stance();
    restart_filter();
  }
  std::uint32_t flags = estimate_.flags & OF_LEARNING;
  const bool rests = contact == ContactState::stance && !foot_->always;
  // A foot that steps rolls while it lands and lifts: that is left out anyway.
  const bool steps = gate_.stances() >= STEPS && gate_.standing_for() < LONGEST_STANCE;
  if (!rests || steps) edge_.restart();
  const bool edge = rests && (inside < EDGE_MARGIN || (!steps && leans(motion, inside, dt)));
  // No ground presses beside the sole: where the centre of pressure reads there for longer than a shock lasts, the sensor
  // is not where it was told to be, or turned, and does not show the edge. Between landing and lift the foot stands flat.
  if (rests && inside < -EDGE_MARGIN && estimate_.load > LIGHT * weight_) beside_time_ += dt;
  left_out_ = doubt.still || (edge && !(steps && beside_time_ > LONGEST_SHOCK));
  if (!edge) inside_until_ = time;
  if (contact != ContactState::stance)
    flags |= NOT_STANDING;
  else
    flags &= ~static_cast<std::uint32_t>(NEVER_LOADED);
  if (edge) flags |= EDGE;
  const bool slides = doubt.slips == SlipGate::Verdict::sure;
  if (slides) flags |= SLIP;
  if (struck) flags |= IMPACT;
  if (doubt.contradiction) flags |= CONTRADICTION;
  told_late_ = doubt.late || doubt.late_imu;
  if (told_late_) estimate_.pitch.identified = estimate_.roll.identified = false;
  if (doubt.late) flags |= LATE_WRENCH;
  if (doubt.late_imu) flags |= LATE_IMU;
  if (told_change_ > 0.0) flags |= GROUND_CHANGED, told_change_ -= dt;
  estimate_.flags = flags, estimate_.contact = contact;
  if (!fresh) {
    angles_.restart(), forces_.restart();
    noise_.restart();
    for (SmoothAngle& angle : smooth_) angle.restart();
    restart_filter();
  }
  if (contact != ContactState::stance || left_out_ || struck || slides || doubt.contradiction) {
    if (running_) held_count_ = 0;
    restart_filter();
  }
  filter(motion, time, dt, fresh ? period : 0.0);
  if (axes_[0].doubted() || axes_[1].doubted()) estimate_.flags |= CONTRADICTION;
  // What sensors that contradict each other have said of the ground until that showed is not believed.
  if (doubt.contradiction || doubt.still)
    for (AxisRegression& axis : axes_) axis.forget_suspicion();
  if (contact == ContactState::stance)
    commit(std::min(time - (foot_->always ? 0.0 : gate_.settling()), inside_until_));
}

// Whether the sole tips, as far as the bush is known.
bool FootTracker::leans(const FootKinematics& motion, double inside, double dt) noexcept {
  const double torque[2] = {estimate_.pitch.torque, estimate_.roll.torque};
  std::array<double, 2> angle, bent;
  for (int a = 0; a < 2; ++a) {
    const AxisValues& found = axes_[a].values();
    if (found.groups < FEWEST_GROUPS || !found.plausible(STIFFEST * weight_)) {
      edge_.restart();
      return false;
    }
    const double element = has_element(*foot_, a) ? found.value[SLIP_TORQUE] * element_[a].state() : 0.0;
    angle[a] = motion.angle[a] + bends_[a];
    bent[a] = (torque[a] - found.value[DAMPING] * motion.rate[a] - element) / found.value[STIFFNESS];
  }
  return edge_.step(inside, estimate_.load, angle, bent, dt);
}

void FootTracker::work(int piece) noexcept {
  const int axis = piece % 2;
  if (piece >= 2) {
    if (!has_element(*foot_, axis)) memories_[axis].work();
    return;
  }
  axes_[axis].work();
  if (axes_[axis].jumped()) {
    told_change_ = CHANGE_TOLD;
    memories_[axis].restart();
  }
  publish(axis);
}

// A stumble shows in both axes, so that the one that shows more speaks for the foot.
std::array<double, 2> FootTracker::suspicion() const noexcept {
  const ChangeWatch &pitch = axes_[0].suspicion(), &roll = axes_[1].suspicion();
  return {std::max(pitch.softer(), roll.softer()), std::max(pitch.stiffer(), roll.stiffer())};
}

void FootTracker::change_ground() noexcept {
  for (AxisRegression& axis : axes_)
    if (axis.suspicion().softer() + axis.suspicion().stiffer() > 0.0) axis.jump();
}

void FootTracker::lose_elements() noexcept {
  if (has_element(*foot_, 0) || has_element(*foot_, 1)) lifted_ = begun_elements_ = false;
}

void FootTracker::forget() noexcept {
  for (AxisRegression& axis : axes_) axis.restart();
  for (MemoryWatch& memory : memories_) memory.restart();
  for (int axis = 0; axis < 2; ++axis) publish(axis);
}

void FootTracker::miss(std::uint32_t reason) noexcept {
  estimate_.flags = (estimate_.flags & OF_LEARNING) | reason | NOT_STANDING;
  estimate_.pitch.rate = estimate_.roll.rate = 0.0;
  held_count_ = 0;
  if (reason & TIME_FAULT)  // who knows what has passed: zeros and offsets may be others
    close_blocks();
  if (reason & TIME_FAULT) lifted_ = false, inside_until_ = std::numeric_limits<double>::lowest();
  stood_ = false;  // contact begins anew: that is no lift
  begun_elements_ = lifted_;
  gate_.restart();  // what is told of the contact stays, until readings say otherwise
  shaking_.restart(), edge_.restart();
  noise_.restart();
  angles_.restart(), forces_.restart();
  restart_filter();
}

}  // namespace plantar
