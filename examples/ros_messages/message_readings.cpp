#include "message_readings.hpp"

#include <algorithm>

MessageReadings::MessageReadings(const std::vector<std::string>& joints, std::size_t feet) {
  for (std::size_t place = 0; place < joints.size(); ++place) places_[joints[place]] = place;
  readings_.position.assign(joints.size(), UNREAD);
  readings_.velocity.assign(joints.size(), UNREAD);
  readings_.wrench.assign(feet, {UNREAD, UNREAD, UNREAD, UNREAD, UNREAD, UNREAD});
}

void MessageReadings::read(const sensor_msgs::Imu& message) noexcept {
  const auto& q = message.orientation;
  const auto &w = message.angular_velocity, &a = message.linear_acceleration;
  readings_.has_attitude = message.orientation_covariance[0] != -1.0;
  readings_.attitude = {q.w, q.x, q.y, q.z};
  readings_.angular_velocity = {w.x, w.y, w.z};
  readings_.acceleration = {a.x, a.y, a.z};
}

void MessageReadings::read(std::size_t foot, const geometry_msgs::WrenchStamped& message) noexcept {
  const auto &f = message.wrench.force, &t = message.wrench.torque;
  readings_.wrench[foot] = {f.x, f.y, f.z, t.x, t.y, t.z};
}

void MessageReadings::read(const sensor_msgs::JointState& message) noexcept {
  readings_.time = message.header.stamp.toSec();
  readings_.has_velocity = message.velocity.size() == message.name.size();
  const std::size_t told = std::min(message.name.size(), message.position.size());
  for (std::size_t i = 0; i < told; ++i) {
    const auto found = places_.find(message.name[i]);
    if (found == places_.end()) continue;
    readings_.position[found->second] = message.position[i];
    if (readings_.has_velocity) readings_.velocity[found->second] = message.velocity[i];
  }
}
