// The robot's tree and its motion, as the dynamics kernels read them.
#pragma once

#include <cstdint>

#include "columns.hpp"

namespace plantar {

constexpr int PARAMETERS = 10;        // of a link: m, m c (3), Ixx Ixy Iyy Ixz Iyz Izz
constexpr int FORCE_PARAMETERS = 4;   // those that a force feels; the inertia needs a torque
constexpr int BASE_ROWS = 6;          // force, then torque about the root link's origin, in its axes

enum class Joint : std::int32_t { root, revolute_x, revolute_y, revolute_z, revolute, prismatic };

struct Link {
  std::int32_t parent;  // -1: the root frame
  Joint joint;          // root: the root link of a floating base, at rest in the root frame
  bool turned;          // whether the placement rotates at all
  double axis[3];
  Frame placement;      // of the joint before it moves, in the parent
};

struct Tree {
  const Link* links;
  std::int32_t n_links;
  bool floating;  // link 0 is the root link and the first six rows are its wrench

  std::int32_t first_joint() const { return floating ? 1 : 0; }
  std::int32_t n_rows() const { return floating ? BASE_ROWS + n_links - 1 : n_links; }
  std::int32_t row_of(std::int32_t link) const { return floating ? BASE_ROWS + link - 1 : link; }
};

// The root frame's proper acceleration, angular velocity and angular acceleration, in its own axes; then
// one column for each joint.
struct Motion {
  Column base[9];
  const Column* position;
  const Column* velocity;
  const Column* acceleration;
};

// Where one row of the regressor goes: column c of the row at `data + c * stride`, samples contiguous.
// A null `data` leaves the row out.
struct RowSink {
  double* data;
  std::ptrdiff_t stride;
  const std::int32_t* first_column;  // of each link, -1 where the row does not depend on it
};

// A wrench of the environment on a link: force then torque in `frame`, which is fixed in the link.
struct Contact {
  std::int32_t link;
  Frame frame;
  Column wrench[6];
};

// A frame fixed in a link, with the links on the way to it, from the root on; without those that never move.
struct Carried {
  const std::int32_t* path;
  std::size_t n_path;
  Frame frame;
};

}  // namespace plantar
