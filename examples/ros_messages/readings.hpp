// One tick's readings as plain arrays, in plantar's units, frames and order. What was not read is not a number.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

constexpr double UNREAD = std::numeric_limits<double>::quiet_NaN();

struct Readings {
  double time = UNREAD;                                               // [s]
  std::vector<double> position, velocity;                             // as the model's joints [rad, rad/s]
  std::array<double, 4> attitude = {UNREAD, UNREAD, UNREAD, UNREAD};  // w x y z, IMU to world
  std::array<double, 3> angular_velocity = {UNREAD, UNREAD, UNREAD};  // [rad/s], in the IMU's frame
  std::array<double, 3> acceleration = {UNREAD, UNREAD, UNREAD};      // [m/s²], proper, in the IMU's frame
  std::vector<std::array<double, 6>> wrench;                          // as the model's feet, force then torque
  bool has_velocity = true, has_attitude = true;                      // whether the robot has them at all
};

// Stands for the callbacks of a node: makes messages of the ticks in a file and gives the readings of each.
void replay_messages(const std::string& ticks, const std::vector<std::string>& joints, std::size_t feet,
                     const std::function<void(const Readings&)>& tick);
