// Recorded ticks through the estimator. A line of TICKS holds time, joint positions, attitude, angular velocity, and
// force and torque of each foot.
#include <cstdio>
#include <fstream>
#include <plantar/foot_estimator.hpp>
#include <vector>

namespace {

template <class Values>
void read(std::istream& text, Values& values) {
  for (double& value : values) text >> value;
}

void print(const std::string& foot, const char* axis, const plantar::AxisEstimate& now) {
  std::printf("%s %s: %.2f mrad, K %.3f ± %.3f N·m/rad, %s\n", foot.c_str(), axis, 1e3 * now.deflection,
              now.stiffness.value, now.stiffness.half_width, now.identified ? "identified" : "not known yet");
}

}  // namespace

int main(int count, char** words) {
  if (count != 3) return std::fputs("usage: replay MODEL TICKS\n", stderr), 2;
  const plantar::EstimatorModel model = plantar::load_model(words[1]);
  plantar::FootEstimator estimator(model);  // all memory is taken here

  plantar::Reading reading;  // its spans look at these
  std::vector<double> position(model.joints.size());
  std::array<double, 4> attitude{};
  std::array<double, 3> angular_velocity{};
  std::vector<std::array<double, 6>> wrench(model.feet.size());
  reading.position = position, reading.attitude = attitude, reading.angular_velocity = angular_velocity;
  reading.wrench = wrench;

  std::span<const plantar::FootEstimate> feet;
  std::ifstream ticks(words[2]);
  while (ticks >> reading.time) {
    read(ticks, position), read(ticks, attitude), read(ticks, angular_velocity);
    for (auto& one : wrench) read(ticks, one);
    feet = estimator.step(reading);
  }
  for (std::size_t foot = 0; foot < feet.size(); ++foot) {
    print(model.feet[foot].name, "pitch", feet[foot].pitch);
    print(model.feet[foot].name, "roll", feet[foot].roll);
  }
}
