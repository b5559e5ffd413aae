// What a foot's regressions have found, as its estimate and its flags.
#include "online/foot_tracker.hpp"

namespace plantar {

void FootTracker::publish(int axis) noexcept {
  const AxisValues& values = axes_[axis].values();
  const bool has_memory = memories_[axis].seen();
  const AxisPublished found = published(
      values, {weight_, gain_std_, delay_std_, period_, foot_->unsure[axis], foot_->slip_angle[axis],
               foot_->linear[axis] || memories_[axis].excluded(), has_memory, told_late_});
  AxisEstimate& out = axis == 0 ? estimate_.pitch : estimate_.roll;
  out.stiffness = found.stiffness, out.damping = found.damping, out.slip_torque = found.slip_torque;
  out.offset = values.offset, out.identified = found.identified;
  learnt_compliance_[axis] = found.compliance;
  estimate_.compliance = learnt_by_both(learnt_compliance_[0], learnt_compliance_[1], foot_->compliance);
  late_[axis] = found.late, late_imu_[axis] = found.late_imu;
  const auto tell = [this](std::uint32_t flag, bool holds) {
    estimate_.flags = holds ? estimate_.flags | flag : estimate_.flags & ~flag;
  };
  tell(axis == 0 ? PITCH_UNKNOWN : ROLL_UNKNOWN, !found.sure);
  tell(axis == 0 ? PITCH_MEMORY : ROLL_MEMORY, has_memory);
  tell(axis == 0 ? PITCH_UNTESTED : ROLL_UNTESTED, found.sure && !found.tested && !has_memory);
}

}  // namespace plantar
