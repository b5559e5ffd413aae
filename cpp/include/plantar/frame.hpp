// A frame fixed in another: rotation (row-major, this frame's axes are its columns) and origin [m].
#pragma once

namespace plantar {

struct Frame {
  double rotation[9];
  double origin[3];
};

}  // namespace plantar
