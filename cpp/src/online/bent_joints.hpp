// Joints that bend beyond their encoders, as behind gears: how far that turns a foot which carries something.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "online/sole.hpp"
#include "plantar/estimator_model.hpp"

namespace plantar {

class BentJoints {
 public:
  explicit BentJoints(const FootModel& foot) : foot_(&foot), first_(foot.path.size()) {
    for (std::size_t k = foot.path.size(); k-- > 0;)
      if (foot.path[k].compliance != 0.0) first_ = k;
  }

  // By how much pitch and roll are more than encoders say [rad]. up: the world's, of length 1, and wrench: that the
  // ground presses with, both in the bush frame; position: of all joints.
  std::array<double, 2> more(const double* up, const std::array<double, 6>& wrench,
                             std::span<const double> position) const noexcept {
    if (first_ == foot_->path.size()) return {};
    const Vector3 turned = turn(wrench, position), change = cross(up, turned.data());
    const double level = std::sqrt(up[0] * up[0] + up[2] * up[2]), over = 1.0 / std::max(level, 1e-12);
    const double pitch = (up[2] * change[0] - up[0] * change[2]) * over * over;
    return {pitch, up[1] * (up[0] * change[0] + up[2] * change[2]) * over - level * change[1]};
  }

 private:
  // How far the bush frame turns beyond where encoders have it, in its own axes [rad].
  Vector3 turn(const std::array<double, 6>& wrench, std::span<const double> position) const noexcept {
    Vector3 turned = {};
    Frame bush = foot_->bush;  // behind the joint
    for (std::size_t k = foot_->path.size(); k-- > first_;) {
      const PathJoint& joint = foot_->path[k];
      const double* axis = bush.rotation + 6;
      const Vector3 arm = rotated_back(bush.rotation, bush.origin), moment = cross(arm.data(), wrench.data());
      double torque = 0.0;
      for (int i = 0; i < 3; ++i) torque += axis[i] * (wrench[3 + i] + moment[i]);
      for (int i = 0; i < 3; ++i) turned[i] += joint.compliance * torque * axis[i];
      bush = before(joint, position[joint.joint], bush);
    }
    return turned;
  }

  // A frame behind a joint, in the frame behind the joint before.
  static Frame before(const PathJoint& joint, double position, const Frame& behind) noexcept {
    const double turn = joint.slides ? 0.0 : joint.sign * position, c = std::cos(turn), s = std::sin(turn);
    Frame moved = behind, out;
    for (int i = 0; i < 3; ++i) {
      moved.rotation[i] = c * behind.rotation[i] - s * behind.rotation[3 + i];
      moved.rotation[3 + i] = s * behind.rotation[i] + c * behind.rotation[3 + i];
    }
    moved.origin[0] = c * behind.origin[0] - s * behind.origin[1];
    moved.origin[1] = s * behind.origin[0] + c * behind.origin[1];
    if (joint.slides) moved.origin[2] += joint.sign * position;
    const Vector3 origin = rotated(joint.frame.rotation, moved.origin);
    for (int i = 0; i < 3; ++i) {
      out.origin[i] = joint.frame.origin[i] + origin[i];
      for (int j = 0; j < 3; ++j) {
        out.rotation[3 * i + j] = 0.0;
        for (int k = 0; k < 3; ++k)
          out.rotation[3 * i + j] += joint.frame.rotation[3 * i + k] * moved.rotation[3 * k + j];
      }
    }
    return out;
  }

  const FootModel* foot_;
  std::size_t first_;  // of the path's joints: none before it bends
};

}  // namespace plantar
