// Newton and Euler's outward pass: every link's pose and motion, all in the root frame's axes.
#pragma once

#include "pack.hpp"
#include "tree.hpp"
#include "vec3.hpp"

namespace plantar::PLANTAR_ISA {

struct LinkState {
  Mat3 rotation;       // link axes
  Vec3 origin;
  Vec3 axis;           // of its joint
  Vec3 omega, alpha;   // angular velocity and acceleration
  Vec3 acceleration;   // proper, of the origin
};

PLANTAR_INLINE Mat3 turned_about(const Mat3& m, Joint joint, const double* axis, Lanes s, Lanes c) {
  switch (joint) {
    case Joint::revolute_x: return {m.x, c * m.y + s * m.z, c * m.z - s * m.y};
    case Joint::revolute_y: return {c * m.x - s * m.z, m.y, c * m.z + s * m.x};
    case Joint::revolute_z: return {c * m.x + s * m.y, c * m.y - s * m.x, m.z};
    default: break;
  }
  // Rodrigues: c 1 + s [axis]x + (1 - c) axis axisᵀ, applied on the right.
  const Vec3 along = times(m, axis);
  const Lanes k = 1.0 - c;
  return {c * m.x + s * (axis[2] * m.y - axis[1] * m.z) + (k * axis[0]) * along,
          c * m.y + s * (axis[0] * m.z - axis[2] * m.x) + (k * axis[1]) * along,
          c * m.z + s * (axis[1] * m.x - axis[0] * m.y) + (k * axis[2]) * along};
}

PLANTAR_INLINE LinkState root_state(const Motion& motion, std::size_t first, std::size_t last) {
  const Lanes one = splat(1.0), zero = Lanes{};
  Lanes base[9];
  for (int i = 0; i < 9; ++i) base[i] = gather(motion.base[i], first, last);
  return {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}},
          {zero, zero, zero},
          {zero, zero, zero},
          {base[3], base[4], base[5]},
          {base[6], base[7], base[8]},
          {base[0], base[1], base[2]}};
}

// A link's place, given its parent's, with its joint at q: all but its motion. Returns the arm from the parent's
// origin.
PLANTAR_INLINE Vec3 place(const Link& link, const LinkState& parent, Lanes q, LinkState& state) {
  const Mat3 rest = link.turned ? times_matrix(parent.rotation, link.placement.rotation) : parent.rotation;
  Vec3 arm = times(parent.rotation, link.placement.origin);
  state.axis = times(rest, link.axis);
  state.rotation = rest;
  if (link.joint == Joint::prismatic) {
    arm = arm + q * state.axis;
  } else {
    Lanes s, c;
    sincos(q, s, c);
    state.rotation = turned_about(rest, link.joint, link.axis, s, c);
  }
  state.origin = parent.origin + arm;
  return arm;
}

// Proper acceleration of what is fixed to a frame at `arm` from its origin.
PLANTAR_INLINE Vec3 acceleration_at(const LinkState& state, Vec3 arm) {
  return state.acceleration + cross(state.alpha, arm) + cross(state.omega, cross(state.omega, arm));
}

PLANTAR_INLINE void forward_link(const Tree& tree, std::int32_t i, const Motion& motion, std::size_t first,
                                 std::size_t last, const LinkState& parent, LinkState& state) {
  const Link& link = tree.links[i];
  const std::int32_t j = i - tree.first_joint();
  const Vec3 arm = place(link, parent, gather(motion.position[j], first, last), state);
  const Lanes v = gather(motion.velocity[j], first, last), a = gather(motion.acceleration[j], first, last);
  const Vec3 coriolis = v * cross(parent.omega, state.axis);
  state.omega = parent.omega;
  state.alpha = parent.alpha;
  state.acceleration = acceleration_at(parent, arm);
  if (link.joint == Joint::prismatic) {
    state.acceleration = state.acceleration + a * state.axis + 2.0 * coriolis;
  } else {
    state.omega = state.omega + v * state.axis;
    state.alpha = state.alpha + a * state.axis + coriolis;
  }
}

inline void forward(const Tree& tree, const Motion& motion, std::size_t first, std::size_t last, LinkState* states) {
  const LinkState root = root_state(motion, first, last);
  for (std::int32_t i = 0; i < tree.n_links; ++i) {
    const Link& link = tree.links[i];
    const LinkState& parent = link.parent < 0 ? root : states[link.parent];
    if (link.joint == Joint::root) {
      states[i] = parent;
    } else {
      forward_link(tree, i, motion, first, last, parent, states[i]);
    }
  }
}

}  // namespace plantar::PLANTAR_ISA
