// What a foot's regressions have found, as estimates: intervals, flags, what may be called identified.
#include <algorithm>
#include <cmath>

#include "online/foot_tracker.hpp"

namespace plantar {

namespace {

// Of a period: how far apart the readings of one tick are, and how far a sample is from what it stands for: motors
// that are told something new at each tick shake the joints in step with the samples.
constexpr double SKEW = 0.03;
constexpr double TRUSTED = 0.1;  // half width over stiffness
constexpr double TOLD = 0.01;    // the same, by what was told of the element alone: a tenth of that
constexpr double NORMAL = 1.96;
constexpr double UNMODELLED = 0.07;  // of a learnt compliance: what the model leaves where no sensor has noise
constexpr double MOST_HELD = 0.999;  // of a compliance, by what was expected of it: beyond, nothing was learnt
// Student's t for 95 %, by degrees of freedom from 2.
constexpr double QUANTILE[] = {4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201};

// Deviations of independent causes; none comes near the ends of a double's range.
double together(double a, double b, double c = 0.0) noexcept { return std::sqrt(a * a + b * b + c * c); }

}  // namespace

void FootTracker::publish(int axis) noexcept {
  const AxisValues& found = axes_[axis].values();
  AxisEstimate& out = axis == 0 ? estimate_.pitch : estimate_.roll;
  const double k = found.value[STIFFNESS], c = found.value[DAMPING];
  const double quantile = QUANTILE[std::clamp(found.groups - 1, 2, 11) - 2];
  const auto parameter = [&](Unknown unknown, double systematic) {
    const double rows = std::max(quantile * found.grouped[unknown], NORMAL * found.white[unknown]);
    const double beside = together(found.moved[unknown], systematic);
    return Parameter{found.value[unknown], together(found.std[unknown], beside),
                     together(rows, NORMAL * found.told[unknown], NORMAL * beside)};
  };
  // A wrench that is late by more than it was told to be takes K·delay off the damping and adds C·ω²·delay to K; where
  // an element does not slip, it is as stiff as K and more.
  // Which of a spring's torques and those of an element that hardly slips is late, rows do not say.
  const auto half_of = [&](const Untold& one) { return std::max(quantile * one.grouped, NORMAL * one.white); };
  const double late_half = half_of(found.late), turned_half = half_of(found.turned);
  const double surely = has_element(*foot_, axis) ? 0.0 : std::max(std::abs(found.late.value) - late_half, 0.0);
  const double late = together(delay_std_, SKEW * period_, surely);
  out.stiffness = parameter(STIFFNESS, together(gain_std_ * k, late * found.by_late[STIFFNESS]));
  out.damping = parameter(DAMPING, together(gain_std_ * c, late * found.by_late[DAMPING]));
  out.slip_torque =
      has_element(*foot_, axis) ? parameter(SLIP_TORQUE, gain_std_ * found.value[SLIP_TORQUE]) : Parameter{};
  out.offset = found.offset;
  // A slide that is softer than anyone expects is held back by that expectation, whose deviation says nothing of it.
  const double held = std::clamp(found.held, 0.0, MOST_HELD);
  learnt_compliance_[axis] = parameter(COMPLIANCE, found.value[COMPLIANCE] * held / (1.0 - held));
  publish_compliance();
  const bool sure =
      found.groups >= FEWEST_GROUPS && found.plausible(STIFFEST * weight_) && out.stiffness.half_width < TRUSTED * k;
  // Within its slip angle an element is a stiffer spring: what is the spring's and what the element's, only the torque
  // says that was told.
  const bool tested = has_element(*foot_, axis) ? NORMAL * found.by_element < TOLD * k
                                                : foot_->linear[axis] || memories_[axis].excluded();
  // A memory that is not modelled delays torques, too.
  const bool modelled = has_element(*foot_, axis) || foot_->linear[axis] || memories_[axis].excluded();
  const bool shows = modelled && !memories_[axis].seen() && found.groups >= FEWEST_GROUPS;
  late_[axis] = shows ? Lateness::of(found.late.value, late_half) : Lateness{};
  // Where an element does not slip, more torque hangs on the angle: there the IMU is later than by this at least.
  const double stiffest = k + (has_element(*foot_, axis) ? found.value[SLIP_TORQUE] / slip_angle_[axis] : 0.0);
  late_imu_[axis] = shows && sure ? Lateness::of(found.turned.value / stiffest, turned_half / stiffest) : Lateness{};
  out.identified = sure && tested && !memories_[axis].seen() && !told_late_;
  const auto tell = [this](std::uint32_t flag, bool holds) {
    estimate_.flags = holds ? estimate_.flags | flag : estimate_.flags & ~flag;
  };
  tell(axis == 0 ? PITCH_UNKNOWN : ROLL_UNKNOWN, !sure);
  tell(axis == 0 ? PITCH_MEMORY : ROLL_MEMORY, memories_[axis].seen());
  tell(axis == 0 ? PITCH_UNTESTED : ROLL_UNTESTED, sure && !tested && !memories_[axis].seen());
}

// Both axes have learnt it, each with a prior of its own, from torques of the same load. The horizontal forces' torque
// is hundredths of a newton metre: there the axes differ by more than each knows of itself, and both by what no model
// has.
void FootTracker::publish_compliance() noexcept {
  const Parameter &p = learnt_compliance_[0], &r = learnt_compliance_[1];
  const double share = r.std > 0.0 ? r.std * r.std / (p.std * p.std + r.std * r.std) : 0.0;
  const auto mean = [share](double pitch, double roll) { return share * pitch + (1.0 - share) * roll; };
  const double value = mean(p.value, r.value);
  const double apart = std::sqrt(mean((p.value - value) * (p.value - value), (r.value - value) * (r.value - value)));
  const double beside = together(apart, UNMODELLED * value);
  estimate_.compliance = {foot_->compliance + value, together(std::min(p.std, r.std), beside),
                          together(std::min(p.half_width, r.half_width), NORMAL * beside)};
}

}  // namespace plantar
