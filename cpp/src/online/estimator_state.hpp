// What the estimator keeps from tick to tick: its feet, the watches over its sensors, the last readings.
#pragma once

#include <vector>

#include "kernels.hpp"
#include "online/attitude_filter.hpp"
#include "online/channel_watch.hpp"
#include "online/contradiction.hpp"
#include "online/delay_watch.hpp"
#include "online/foot_tracker.hpp"
#include "online/path_bundles.hpp"
#include "plantar/foot_estimator.hpp"

namespace plantar {

struct FootEstimator::State {
  explicit State(const EstimatorModel& given);

  void step(const Reading& reading) noexcept;
  enum class Time { onward, still, jumped };
  Time keep_time(double now) noexcept;
  bool imu(const Reading& reading) noexcept;
  void joints(const Reading& reading) noexcept;
  void miss_all(std::uint32_t reason) noexcept;
  void watch_ground() noexcept;
  bool weight_differs(double total) noexcept;
  bool encoder_doubtful(std::size_t foot) const noexcept;

  const EstimatorModel model;
  const double weight;
  WeightWatch weight_watch;
  TurnWatch turn_watch;
  bool turns_differ = false;
  DelayWatch delay_watch;                    // of all feet together, for which one delay was told
  DelayWatch imu_watch;                      // of the one IMU
  std::vector<DelayWatch> foot_delay_watch;  // of each alone
  PathBundles paths;
  std::vector<int> moving;  // joints on the path of a foot: no other says anything of it
  std::vector<FootTracker> feet;
  std::vector<double> last_position;
  std::vector<JointWatch> joint_watch;
  std::vector<std::uint32_t> joint_bad;
  std::vector<bool> joint_dead;
  std::vector<int> twin;
  std::vector<DeviceWatch<6>> wrench_watch;
  DeviceWatch<4> attitude_watch;
  DeviceWatch<3> gyroscope_watch;
  AttitudeFilter filter;
  SlipGate slip;
  bool gyroscope = false;
  double last_quaternion[4] = {}, last_rate[3] = {};
  std::vector<FootKinematics> motion;
  std::vector<std::uint32_t> bad;
  std::vector<bool> was_bad;
  std::vector<FootEstimate> estimates;
  double time = 0.0, dt = 0.0, period = 0.0;
  double steady = 0.0, clock_doubt = 0.0;  // s since time jumped, and for which nothing is learnt, as it did again
  int ticks = 0;       // since time last jumped
  bool known = false;  // whether a quaternion and positions of an earlier tick are kept
  int next_work = 0;
};

}  // namespace plantar
