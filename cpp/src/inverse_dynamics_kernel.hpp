// The left side of eq. 1 for given parameters, less what the contacts carry: Y phi - sum of K_k F_k.
#pragma once

#include "regressor_kernel.hpp"

namespace plantar::PLANTAR_ISA {

// Force and torque that move one link with the ten parameters p, about the root frame's origin.
PLANTAR_INLINE Wrench link_wrench(const LinkState& s, const double* p) {
  const Vec3 moment = times(s.rotation, p + 1);
  const Vec3 omega = transposed(s.rotation, s.omega), alpha = transposed(s.rotation, s.alpha);
  const double inertia[9] = {p[4], p[5], p[7], p[5], p[6], p[8], p[7], p[8], p[9]};
  const auto product = [&](Vec3 x) {
    return Vec3{inertia[0] * x.x + inertia[1] * x.y + inertia[2] * x.z,
                inertia[3] * x.x + inertia[4] * x.y + inertia[5] * x.z,
                inertia[6] * x.x + inertia[7] * x.y + inertia[8] * x.z};
  };
  const Vec3 force = p[0] * s.acceleration + cross(s.alpha, moment) + cross(s.omega, cross(s.omega, moment));
  const Vec3 spin = s.rotation * (product(alpha) + cross(omega, product(omega)));
  return {force, spin + cross(moment, s.acceleration) + cross(s.origin, force)};
}

// parameters: ten a link, or null where only the contacts are wanted. rows: one contiguous array a row.
inline void inverse_dynamics(const Tree& tree, const Motion& motion, const double* parameters, const Contact* contacts,
                             std::size_t n_contacts, std::size_t begin, std::size_t end, double* const* rows,
                             double* work) {
  LinkState* states = reinterpret_cast<LinkState*>(work);
  Wrench* wrenches = reinterpret_cast<Wrench*>(states + tree.n_links);
  for (std::size_t first = begin; first < end; first += LANES) {
    const std::size_t count = end - first;
    forward(tree, motion, first, end, states);
    for (std::int32_t i = 0; i < tree.n_links; ++i)
      wrenches[i] = parameters != nullptr ? link_wrench(states[i], parameters + PARAMETERS * i) : Wrench{};
    Wrench total = {};  // what reaches the root frame of a fixed base is not asked for
    for (std::size_t k = 0; k < n_contacts; ++k) {
      const Contact& contact = contacts[k];
      const LinkState& s = states[contact.link];
      const Mat3 frame = times_matrix(s.rotation, contact.frame.rotation);
      const Vec3 origin = s.origin + times(s.rotation, contact.frame.origin);
      Lanes w[6];
      for (int i = 0; i < 6; ++i) w[i] = gather(contact.wrench[i], first, end);
      const Vec3 force = frame * Vec3{w[0], w[1], w[2]};
      Wrench& at = wrenches[contact.link];
      at.force = at.force - force;
      at.torque = at.torque - frame * Vec3{w[3], w[4], w[5]} - cross(origin, force);
    }
    for (std::int32_t i = tree.n_links - 1; i >= tree.first_joint(); --i) {
      const LinkState& s = states[i];
      const Wrench& w = wrenches[i];
      const bool slides = tree.links[i].joint == Joint::prismatic;
      const Lanes row = slides ? dot(s.axis, w.force) : dot(s.axis, w.torque - cross(s.origin, w.force));
      scatter(rows[tree.row_of(i)] + first, row, count);
      const std::int32_t parent = tree.links[i].parent;
      Wrench& onto = parent < 0 ? total : wrenches[parent];
      onto.force = onto.force + w.force;
      onto.torque = onto.torque + w.torque;
    }
    if (tree.floating) {
      const Wrench& base = wrenches[0];
      const Lanes six[BASE_ROWS] = {base.force.x,  base.force.y,  base.force.z,
                                    base.torque.x, base.torque.y, base.torque.z};
      for (int i = 0; i < BASE_ROWS; ++i) scatter(rows[i] + first, six[i], count);
    }
  }
}

// What several sets of parameters, ten a link each, take at the root frame of a floating base, without contacts: the
// links' motion is found once for all. out: (sets, samples, 6).
inline void base_wrenches(const Tree& tree, const Motion& motion, const double* parameters, std::size_t sets,
                          std::size_t begin, std::size_t end, std::size_t samples, double* out, double* work) {
  LinkState* states = reinterpret_cast<LinkState*>(work);
  const std::size_t size = static_cast<std::size_t>(PARAMETERS * tree.n_links);
  for (std::size_t first = begin; first < end; first += LANES) {
    const std::size_t count = end - first < LANES ? end - first : LANES;
    forward(tree, motion, first, end, states);
    for (std::size_t set = 0; set < sets; ++set) {
      Wrench base = {};
      for (std::int32_t i = 0; i < tree.n_links; ++i) {
        const Wrench own = link_wrench(states[i], parameters + set * size + PARAMETERS * i);
        base.force = base.force + own.force;
        base.torque = base.torque + own.torque;
      }
      const Lanes six[BASE_ROWS] = {base.force.x,  base.force.y,  base.force.z,
                                    base.torque.x, base.torque.y, base.torque.z};
      double* rows = out + (set * samples + first) * BASE_ROWS;
      for (std::size_t l = 0; l < count; ++l)
        for (int i = 0; i < BASE_ROWS; ++i) rows[l * BASE_ROWS + i] = six[i][l];
    }
  }
}

}  // namespace plantar::PLANTAR_ISA
