// Messages of a file of ticks, as examples/controller/replay.cpp reads it: a node gets them from its subscribers.
#include <fstream>

#include "message_readings.hpp"

void replay_messages(const std::string& ticks, const std::vector<std::string>& joints, std::size_t feet,
                     const std::function<void(const Readings&)>& tick) {
  MessageReadings taken(joints, feet);
  sensor_msgs::JointState state;
  state.name.assign(joints.rbegin(), joints.rend());  // the order is the driver's
  state.name.insert(state.name.begin(), "gripper");   // which may know of more
  state.position.resize(state.name.size());
  sensor_msgs::Imu imu;
  std::vector<geometry_msgs::WrenchStamped> wrenches(feet);

  std::ifstream text(ticks);
  for (double time; text >> time;) {
    state.header.stamp.fromSec(time);
    for (std::size_t i = joints.size(); i > 0; --i) text >> state.position[i];
    auto& q = imu.orientation;
    text >> q.w >> q.x >> q.y >> q.z;
    text >> imu.angular_velocity.x >> imu.angular_velocity.y >> imu.angular_velocity.z;
    for (auto& one : wrenches) {
      auto &f = one.wrench.force, &t = one.wrench.torque;
      text >> f.x >> f.y >> f.z >> t.x >> t.y >> t.z;
    }
    for (std::size_t foot = 0; foot < feet; ++foot) taken.read(foot, wrenches[foot]);
    taken.read(imu);
    taken.read(state);
    tick(taken.readings());
  }
}
