// The rows of eq. 1 that multiply the inertial parameters: Y_BI and Y_JI, only where a row depends on a link.
#pragma once

#include "forward.hpp"

namespace plantar::PLANTAR_ISA {

struct Wrench {
  Vec3 force, torque;  // about the root frame's origin
};

// One column of a link, in all rows that it reaches: the base wrench and the joints between link and root.
struct ColumnWriter {
  const Tree& tree;
  const LinkState* states;
  const RowSink* sinks;
  std::int32_t link;
  std::size_t offset, count;
  bool joints;  // whether any joint's row is wanted

  PLANTAR_INLINE void put(std::int32_t row, std::int32_t slot, Lanes x) const {
    const RowSink& sink = sinks[row];
    if (sink.data == nullptr) return;
    scatter(sink.data + (sink.first_column[link] + slot) * sink.stride + offset, x, count);
  }

  PLANTAR_INLINE void write(std::int32_t slot, std::int32_t force_slot, const Wrench& w, bool has_force) const {
    if (tree.floating) {
      if (has_force) {
        put(0, force_slot, w.force.x);
        put(1, force_slot, w.force.y);
        put(2, force_slot, w.force.z);
      }
      put(3, slot, w.torque.x);
      put(4, slot, w.torque.y);
      put(5, slot, w.torque.z);
    }
    if (!joints) return;
    for (std::int32_t k = link; k >= tree.first_joint(); k = tree.links[k].parent) {
      const std::int32_t row = tree.row_of(k);
      if (sinks[row].data == nullptr) continue;
      const LinkState& joint = states[k];
      if (tree.links[k].joint == Joint::prismatic) {
        put(row, slot, has_force ? dot(joint.axis, w.force) : Lanes{});
      } else {
        const Vec3 about = has_force ? w.torque - cross(joint.origin, w.force) : w.torque;
        put(row, slot, dot(joint.axis, about));
      }
    }
  }
};

// kept[link]: bit p set where parameter p has a column. Samples [first, last) go to the sinks from `offset` on.
inline void regressor_pack(const Tree& tree, const LinkState* states, const std::uint32_t* kept, const RowSink* sinks,
                           std::size_t offset, std::size_t count) {
  bool joints = false;
  for (std::int32_t row = tree.row_of(tree.first_joint()); row < tree.n_rows(); ++row)
    joints |= sinks[row].data != nullptr;
  for (std::int32_t i = 0; i < tree.n_links; ++i) {
    const std::uint32_t mask = kept[i];
    if (mask == 0) continue;
    const LinkState& s = states[i];
    const ColumnWriter out = {tree, states, sinks, i, offset, count, joints};
    const Vec3 r[3] = {s.rotation.x, s.rotation.y, s.rotation.z};
    Vec3 c[3];
    Lanes omega[3], alpha[3];
    for (int j = 0; j < 3; ++j) {
      c[j] = cross(s.omega, r[j]);
      omega[j] = dot(s.omega, r[j]);
      alpha[j] = dot(s.alpha, r[j]);
    }
    std::int32_t slot = 0;
    if (mask & 1u) {
      out.write(slot, slot, {s.acceleration, cross(s.origin, s.acceleration)}, true);
      ++slot;
    }
    for (int j = 0; j < 3; ++j) {
      if (!(mask & (2u << j))) continue;
      const Vec3 force = cross(s.alpha, r[j]) + cross(s.omega, c[j]);
      out.write(slot, slot, {force, cross(r[j], s.acceleration) + cross(s.origin, force)}, true);
      ++slot;
    }
    constexpr int row[6] = {0, 0, 1, 0, 1, 2}, column[6] = {0, 1, 1, 2, 2, 2};
    for (int p = 0; p < 6; ++p) {
      if (!(mask & (16u << p))) continue;
      const int j = row[p], k = column[p];
      Vec3 torque = alpha[k] * r[j] + omega[k] * c[j];
      if (j != k) torque = torque + alpha[j] * r[k] + omega[j] * c[k];
      out.write(slot, 0, {Vec3{}, torque}, false);
      ++slot;
    }
  }
}

inline void regressor(const Tree& tree, const Motion& motion, const std::uint32_t* kept, const RowSink* sinks,
                      std::size_t begin, std::size_t end, std::size_t offset, double* work) {
  LinkState* states = reinterpret_cast<LinkState*>(work);
  for (std::size_t first = begin; first < end; first += LANES) {
    forward(tree, motion, first, end, states);
    regressor_pack(tree, states, kept, sinks, offset + first - begin, end - first);
  }
}

}  // namespace plantar::PLANTAR_ISA
