// One frame on the robot, seen from its root: the root's motion from an IMU there, and what a contact there carries.
#pragma once

#include "forward.hpp"

namespace plantar::PLANTAR_ISA {

// The state of the link that carries the frame, given the root frame's.
PLANTAR_INLINE LinkState carrier(const Tree& tree, const Carried& carried, const Motion& motion, std::size_t first,
                                 std::size_t last, LinkState root) {
  for (std::size_t i = 0; i < carried.n_path; ++i) {
    const LinkState parent = root;
    forward_link(tree, carried.path[i], motion, first, last, parent, root);
  }
  return root;
}

// The root frame's motion from that of an IMU anywhere on the robot, both nine columns as `Motion::base`, each in its
// own axes. First the joints turn the IMU while the root rests; what turns beyond that is the root. Then they move it
// about a root that turns so but does not accelerate; what is measured beyond that is the root's acceleration. Attitude
// never enters. joints: their motion; its base is not read. out: (samples, 9).
inline void root_motion(const Tree& tree, const Carried& imu, const Motion& joints, const Column* measured,
                        std::size_t begin, std::size_t end, double* out) {
  const Lanes one = splat(1.0), zero = Lanes{};
  const Vec3 none = {zero, zero, zero};
  for (std::size_t first = begin; first < end; first += LANES) {
    LinkState root = {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}, none, none, none, none, none};
    const LinkState turned = carrier(tree, imu, joints, first, end, root);
    const Mat3 axes = times_matrix(turned.rotation, imu.frame.rotation);
    Vec3 seen[3];
    for (int i = 0; i < 3; ++i)
      seen[i] = axes * Vec3{gather(measured[3 * i], first, end), gather(measured[3 * i + 1], first, end),
                            gather(measured[3 * i + 2], first, end)};
    root.omega = seen[1] - turned.omega;
    root.alpha = seen[2] - turned.alpha - cross(root.omega, turned.omega);
    const LinkState moved = carrier(tree, imu, joints, first, end, root);
    const Vec3 acceleration = seen[0] - acceleration_at(moved, times(moved.rotation, imu.frame.origin));
    const Lanes nine[9] = {acceleration.x, acceleration.y, acceleration.z, root.omega.x, root.omega.y,
                           root.omega.z,   root.alpha.x,   root.alpha.y,   root.alpha.z};
    for (std::size_t l = 0; l < LANES && first + l < end; ++l)
      for (int i = 0; i < 9; ++i) out[(first + l) * 9 + static_cast<std::size_t>(i)] = nine[i][l];
  }
}

// A contact's wrench, in its frame's axes, to the root frame's: (samples, 6, 6). positions: of all joints.
inline void base_transfer(const Tree& tree, const Carried& contact, const Column* positions, std::size_t begin,
                          std::size_t end, double* out) {
  const Lanes one = splat(1.0), zero = Lanes{};
  const Vec3 none = {zero, zero, zero};
  for (std::size_t first = begin; first < end; first += LANES) {
    LinkState state = {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}, none, none, none, none, none};
    for (std::size_t i = 0; i < contact.n_path; ++i) {
      const LinkState parent = state;
      const std::int32_t link = contact.path[i];
      place(tree.links[link], parent, gather(positions[link - tree.first_joint()], first, end), state);
    }
    const Mat3 axes = times_matrix(state.rotation, contact.frame.rotation);
    const Vec3 origin = state.origin + times(state.rotation, contact.frame.origin);
    const Vec3 forces[3] = {axes.x, axes.y, axes.z};
    Lanes six[6][6] = {};
    for (int k = 0; k < 3; ++k) {
      const Vec3 moment = cross(origin, forces[k]);
      six[0][k] = six[3][k + 3] = forces[k].x, six[3][k] = moment.x;
      six[1][k] = six[4][k + 3] = forces[k].y, six[4][k] = moment.y;
      six[2][k] = six[5][k + 3] = forces[k].z, six[5][k] = moment.z;
    }
    for (std::size_t l = 0; l < LANES && first + l < end; ++l)
      for (int i = 0; i < 36; ++i) out[(first + l) * 36 + static_cast<std::size_t>(i)] = six[i / 6][i % 6][l];
  }
}

}  // namespace plantar::PLANTAR_ISA
