// What a foot's regressions have found, as estimates: intervals, flags, what may be called identified.
#include <algorithm>
#include <cmath>

#include "online/foot_tracker.hpp"
#include "online/half_widths.hpp"

namespace plantar {

namespace {

// Of a period: how far apart the readings of one tick are, and how far a sample is from what it stands for: motors
// that are told something new at each tick shake the joints in step with the samples.
constexpr double SKEW = 0.03;
constexpr double TRUSTED = 0.1;  // half width over stiffness
constexpr double TOLD = 0.01;    // the same, by what was told of the element alone: a tenth of that
constexpr double MOST_HELD = 0.999;  // of a compliance, by what was expected of it: beyond, nothing was learnt

}  // namespace

void FootTracker::publish(int axis) noexcept {
  const AxisValues& found = axes_[axis].values();
  AxisEstimate& out = axis == 0 ? estimate_.pitch : estimate_.roll;
  const double k = found.value[STIFFNESS], c = found.value[DAMPING];
  const auto parameter = [&](Unknown unknown, double systematic) {
    const double rows = half_of_rows(found.groups, found.grouped[unknown], found.white[unknown]);
    const double beside = together(found.moved[unknown], systematic);
    return Parameter{found.value[unknown], together(found.std[unknown], beside),
                     together(rows, NORMAL * found.told[unknown], NORMAL * beside)};
  };
  // A wrench that is late by more than it was told to be takes K·delay off the damping and adds C·ω²·delay to K; where
  // an element does not slip, it is as stiff as K and more.
  // Which of a spring's torques and those of an element that hardly slips is late, rows do not say.
  const auto half_of = [&](const Untold& one) { return half_of_rows(found.groups, one.grouped, one.white); };
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
  estimate_.compliance = learnt_by_both(learnt_compliance_[0], learnt_compliance_[1], foot_->compliance);
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

}  // namespace plantar
