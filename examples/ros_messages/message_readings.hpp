// ROS 1 messages to readings.
//
// sensor_msgs/JointState: positions [rad] and velocities [rad/s] by name, in any order. sensor_msgs/Imu: a quaternion
// x y z w that turns the IMU's frame into the world's; a covariance that begins with -1 says that there is none.
// geometry_msgs/WrenchStamped: N and N·m in the frame that its header names, which is that of `wrench` in the robot
// file. ROS does not say on what the wrench acts: behind the robot file's `sign` a standing robot reads force.z > 0.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <unordered_map>

#include "readings.hpp"

class MessageReadings {
 public:
  // Joints as in the estimator's model. All memory is taken here.
  MessageReadings(const std::vector<std::string>& joints, std::size_t feet);

  // Each keeps what its message says. The joints' time is the tick's, so that they come last.
  void read(const sensor_msgs::Imu& message) noexcept;
  void read(std::size_t foot, const geometry_msgs::WrenchStamped& message) noexcept;
  void read(const sensor_msgs::JointState& message) noexcept;  // joints that the model lacks are passed over

  const Readings& readings() const noexcept { return readings_; }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  Readings readings_;
};
