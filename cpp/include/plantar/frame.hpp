// A frame fixed in another: rotation (row-major, this frame's axes are its columns) and origin [m].
#pragma once

namespace plantar {

// Where a frame stands in another one, and how it is turned.
struct Frame {
  double rotation[9];  // row-major; this frame's axes in the other frame are its columns
  double origin[3];    // in the other frame [m]
};

}  // namespace plantar
