#include "online/path_bundles.hpp"

#include <algorithm>

namespace plantar {

PathBundles::PathBundles(const EstimatorModel& model, const Kernels& kernels)
    : kernels_(kernels),
      lanes_(kernels.lanes),
      feet_in_one_(lanes_ / INSTANTS),
      found_(model.joints.size()) {
  for (const FootModel& foot : model.feet) n_steps_ = std::max(n_steps_, foot.path.size());
  bundle_size_ = (n_steps_ * STEP_ROWS + END_ROWS) * lanes_;
  const std::size_t bundles = (model.feet.size() + feet_in_one_ - 1) / feet_in_one_;
  rows_.resize(bundles * bundle_size_), out_.resize(bundles * IMU_TURN * lanes_);
  // Lanes without a foot repeat the last one: they are read by nobody, and are numbers as good as others.
  for (std::size_t place = 0; place < bundles * feet_in_one_; ++place) {
    const std::size_t f = std::min(place, model.feet.size() - 1);
    const FootModel& foot = model.feet[f];
    const std::size_t begin = place / feet_in_one_ * bundle_size_ + lane(place);
    const auto put = [&](std::size_t row, double value) {
      std::fill_n(rows_.begin() + static_cast<std::ptrdiff_t>(begin + row * lanes_), INSTANTS, value);
    };
    const auto put_frame = [&](std::size_t rotation, std::size_t origin, const Frame& frame) {
      for (std::size_t i = 0; i < 9; ++i) put(rotation + i, frame.rotation[i]);
      for (std::size_t i = 0; i < 3; ++i) put(origin + i, frame.origin[i]);
    };
    // Steps beyond a shorter path stand still.
    const PathJoint rest = {.joint = -1, .slides = false, .sign = 0.0, .frame = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {}}};
    for (std::size_t i = 0; i < n_steps_; ++i) {
      const PathJoint& step = i < foot.path.size() ? foot.path[i] : rest;
      const std::size_t first = i * STEP_ROWS;
      put_frame(first + STEP_ROTATION, first + STEP_ORIGIN, step.frame);
      put(first + TURNS, step.slides ? 0.0 : step.sign), put(first + SLIDES, step.slides ? step.sign : 0.0);
      if (step.joint >= 0 && place == f) found_[step.joint].push_back(begin + (first + POSITION) * lanes_);
    }
    const std::size_t end = n_steps_ * STEP_ROWS;
    put_frame(end + BUSH_ROTATION, end + BUSH_ORIGIN, foot.bush);
    put_frame(end + SOLE_ROTATION, end + SOLE_ORIGIN, foot.sole);
  }
}

void PathBundles::run() noexcept {
  Attitude attitude;
  for (int i = 0; i < 4; ++i) attitude.quaternion[i] = {quaternion_[i], 1};
  for (int i = 0; i < 3; ++i) attitude.angular_velocity[i] = {angular_velocity_[i], 1};
  for (std::size_t b = 0; b * bundle_size_ < rows_.size(); ++b)
    kernels_.chain_bundle({rows_.data() + b * bundle_size_, n_steps_}, attitude, out_.data() + b * IMU_TURN * lanes_);
}

void PathBundles::read(std::size_t foot, FootKinematics& to) const noexcept {
  const double* out = out_.data() + foot / feet_in_one_ * IMU_TURN * lanes_ + lane(foot);
  const auto now = [&](int row) { return out[row * lanes_]; };
  const auto middle = [&](int row) { return out[row * lanes_ + 1]; };
  for (int i = 0; i < 3; ++i) to.up[i] = now(UP + i);
  for (int i = 0; i < 2; ++i) {
    to.angle[i] = now(DEFLECTION + i), to.mean_angle[i] = middle(DEFLECTION + i);
    to.rate[i] = now(RATE + i), to.mean_rate[i] = middle(RATE + i);
    to.turning[i] = now(RATE + i) - now(ENCODER_RATE + i);
  }
  to.place = {now(SOLE_POSITION), now(SOLE_POSITION + 1), now(HEADING)};
}

}  // namespace plantar
