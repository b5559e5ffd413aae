// What a foot's force sensor says at the bush: what the load kernel reads and writes (paper 3.2).
#pragma once

#include "columns.hpp"

namespace plantar {

struct SoleLoad {
  Frame sensor;       // in the bush frame
  double sign;        // -1 where it reads what the robot does to the ground
  Column reading[6];  // force, torque
  Column up[3];       // the world's up in the bush frame
  Frame sole;         // in the bush frame when the bush is not deflected
  double least;       // force along the sole's normal below which there is no centre of pressure [N]
};

// Rows of the output, each one a contiguous array of all samples.
enum LoadOutput {
  WRENCH = 0,   // 6: at the bush centre, in the bush frame
  TORQUE = 6,   // 2: about the bush's pitch and roll axes
  FORCE_Z = 8,  // 1: along the vertical
  COP = 9,      // 2: centre of pressure in the sole frame, NaN without load
  LOAD_OUTPUTS = 11
};

}  // namespace plantar
