// The estimator behind ROS 1 messages: feet_of_messages MODEL TICKS.
#include <cstdio>
#include <plantar/foot_estimator.hpp>

#include "readings.hpp"

namespace {

plantar::Reading reading_of(const Readings& now) {
  plantar::Reading reading;
  reading.time = now.time, reading.position = now.position, reading.wrench = now.wrench;
  reading.angular_velocity = now.angular_velocity, reading.acceleration = now.acceleration;
  if (now.has_velocity) reading.velocity = now.velocity;
  if (now.has_attitude) reading.attitude = now.attitude;
  return reading;
}

void print(const std::string& foot, const char* axis, const plantar::AxisEstimate& now) {
  std::printf("%s %s: %.2f mrad, K %.3f ± %.3f N·m/rad, %s\n", foot.c_str(), axis, 1e3 * now.deflection,
              now.stiffness.value, now.stiffness.half_width, now.identified ? "identified" : "not known yet");
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return std::fputs("usage: feet_of_messages MODEL TICKS\n", stderr), 2;
  const plantar::EstimatorModel model = plantar::load_model(words[1]);
  plantar::FootEstimator estimator(model);
  std::span<const plantar::FootEstimate> feet;
  replay_messages(words[2], model.joints, model.feet.size(),
                  [&](const Readings& now) { feet = estimator.step(reading_of(now)); });
  for (std::size_t foot = 0; foot < feet.size(); ++foot) {
    print(model.feet[foot].name, "pitch", feet[foot].pitch);
    print(model.feet[foot].name, "roll", feet[foot].roll);
  }
}
