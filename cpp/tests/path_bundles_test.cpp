// Feet beside each other against the kernel for one foot, on every instruction set: paths of other lengths, joints that
// slide or are passed backwards, a joint of both paths, more feet than one bundle holds.
#include <array>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "online/path_bundles.hpp"

namespace path_bundles_test {

using namespace plantar;

Frame frame(double turn, double x) {
  const double c = std::cos(turn), s = std::sin(turn);
  return {{c, 0, s, s * s, c, -s * c, -s * c, s, c * c}, {x, 0.1 * x, -0.2}};  // Rx(turn) Ry(turn)
}

// A foot's path begins with a joint that all share; each is longer than the one before.
EstimatorModel model_of(int feet) {
  EstimatorModel model;
  model.feet.resize(static_cast<std::size_t>(feet)), model.joints = {"shared"};
  for (int f = 0; f < feet; ++f) {
    FootModel& foot = model.feet[static_cast<std::size_t>(f)];
    foot.path = {{0, false, -1.0, frame(0.3, 0.1)}};
    for (int k = 0; k <= f; ++k) {
      foot.path.push_back({static_cast<int>(model.joints.size()), k == 1, k % 2 ? -1.0 : 1.0, frame(0.4 + k, 0.2 * f)});
      model.joints.push_back("own");
    }
    foot.bush = frame(0.1 * f, 0.05), foot.sole = frame(0.2, 0.03);
  }
  return model;
}

void bundles_find_what_the_chain_finds(int feet, const Kernels& kernels) {
  const EstimatorModel model = model_of(feet);
  PathBundles paths(model, kernels);
  const std::size_t joints = model.joints.size();
  std::vector<double> position(2 * joints), velocity(2 * joints);  // now and in the middle, joint by joint
  for (std::size_t j = 0; j < joints; ++j) {
    for (std::size_t i = 0; i < 2; ++i)
      position[2 * j + i] = std::sin(1.7 * j + 0.1 * i), velocity[2 * j + i] = std::cos(2.3 * j + 0.2 * i);
    paths.set(static_cast<int>(j), {position[2 * j], position[2 * j + 1]}, {velocity[2 * j], velocity[2 * j + 1]});
  }
  const double quaternion[4][2] = {{0.9, 0.8}, {0.1, 0.12}, {-0.2, -0.21}, {0.3, 0.31}};
  const double gyroscope[3][2] = {{0.5, 0.4}, {-0.3, -0.2}, {0.2, 0.25}};
  Attitude attitude, still;
  for (int i = 0; i < 4; ++i) paths.set_attitude(i, {quaternion[i][0], quaternion[i][1]});
  for (int i = 0; i < 3; ++i) paths.set_angular_velocity(i, {gyroscope[i][0], gyroscope[i][1]});
  for (int i = 0; i < 4; ++i) attitude.quaternion[i] = still.quaternion[i] = {quaternion[i], 1};
  for (int i = 0; i < 3; ++i) attitude.angular_velocity[i] = still.angular_velocity[i] = {gyroscope[i], 1};
  paths.run();
  for (int f = 0; f < feet; ++f) {
    const FootModel& foot = model.feet[static_cast<std::size_t>(f)];
    std::vector<ChainStep> steps, at_rest;
    for (const PathJoint& joint : foot.path) {
      const std::size_t at = 2 * static_cast<std::size_t>(joint.joint);
      steps.push_back({joint.frame, joint.slides, joint.sign, {&position[at], 1}, {&velocity[at], 1}});
      at_rest.push_back({joint.frame, joint.slides, joint.sign, {&position[at], 1}, {}});
    }
    double moving[CHAIN_OUTPUTS][2], turning[CHAIN_OUTPUTS][2];
    double *rows[CHAIN_OUTPUTS], *others[CHAIN_OUTPUTS];
    for (int r = 0; r < CHAIN_OUTPUTS; ++r) rows[r] = moving[r], others[r] = turning[r];
    kernels.chain({steps.data(), steps.size(), foot.bush, foot.sole}, attitude, 0, 2, rows);
    kernels.chain({at_rest.data(), at_rest.size(), foot.bush, foot.sole}, still, 0, 2, others);
    FootKinematics found;
    paths.read(static_cast<std::size_t>(f), found);
    for (int i = 0; i < 3; ++i) check::near(found.up[i], moving[UP + i][0], 1e-12, "up");
    for (int i = 0; i < 2; ++i) {
      check::near(found.angle[i], moving[DEFLECTION + i][0], 1e-12, "deflection");
      check::near(found.mean_angle[i], moving[DEFLECTION + i][1], 1e-12, "deflection half a period before");
      check::near(found.rate[i], moving[RATE + i][0], 1e-11, "rate");
      check::near(found.mean_rate[i], moving[RATE + i][1], 1e-11, "rate half a period before");
      check::near(found.turning[i], turning[RATE + i][0], 1e-11, "what the gyroscope alone adds");
    }
    check::near(found.place.x, moving[SOLE_POSITION][0], 1e-12, "sole, x");
    check::near(found.place.y, moving[SOLE_POSITION + 1][0], 1e-12, "sole, y");
    check::near(found.place.heading, moving[HEADING][0], 1e-12, "heading");
  }
}

void run() {
  for (const Kernels* const* kernels = runnable_kernels(); *kernels != nullptr; ++kernels)
    for (const int feet : {1, 2, 3, 5}) bundles_find_what_the_chain_finds(feet, **kernels);
}

const check::Listed listed(run);

}  // namespace path_bundles_test
