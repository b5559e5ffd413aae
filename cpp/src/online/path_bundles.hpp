// The paths of all feet, as many beside each other as the kernels have lanes for: one walk over their joints a tick.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels.hpp"
#include "online/foot_kinematics.hpp"
#include "plantar/estimator_model.hpp"

namespace plantar {

constexpr std::size_t MOST_LANES = 8;

class PathBundles {
 public:
  // One number at both instants that are worked out for every foot: this tick, and half a period before.
  struct Instants {
    double now, middle;
  };

  PathBundles(const EstimatorModel& model, const Kernels& kernels);

  // A joint's position [rad or m] and velocity, wherever it is on a path.
  void set(int joint, Instants position, Instants velocity) noexcept {
    for (const std::size_t at : found_[joint]) {
      double *q = rows_.data() + at, *v = q + lanes_ * (VELOCITY - POSITION);
      q[0] = position.now, q[1] = position.middle;
      v[0] = velocity.now, v[1] = velocity.middle;
    }
  }
  void set_attitude(int component, Instants quaternion) noexcept { fill(quaternion_[component], quaternion); }
  void set_angular_velocity(int axis, Instants rate) noexcept { fill(angular_velocity_[axis], rate); }
  // All feet at once; then what was found of each.
  void run() noexcept;
  void read(std::size_t foot, FootKinematics& to) const noexcept;

 private:
  static void fill(double (&row)[MOST_LANES], Instants value) noexcept {
    for (std::size_t lane = 0; lane < MOST_LANES; lane += INSTANTS) row[lane] = value.now, row[lane + 1] = value.middle;
  }
  std::size_t lane(std::size_t foot) const noexcept { return foot % feet_in_one_ * INSTANTS; }

  const Kernels& kernels_;
  std::size_t lanes_, feet_in_one_, n_steps_ = 0, bundle_size_ = 0;
  std::vector<double> rows_;                     // of each bundle, see `Bundle`
  std::vector<double> out_;                      // of each bundle (IMU_TURN, lanes)
  std::vector<std::vector<std::size_t>> found_;  // of each joint, where in `rows_` its positions are
  double quaternion_[4][MOST_LANES] = {}, angular_velocity_[3][MOST_LANES] = {};
};

}  // namespace plantar
