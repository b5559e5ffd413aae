// One foot at one tick, as encoders and IMU show it.
#pragma once

namespace plantar {

struct SolePlace {
  double x, y;     // from the IMU, world axes [m]
  double heading;  // [rad], within half a turn
};

// What the kinematics say of one foot at one tick.
struct FootKinematics {
  double up[3];          // the world's up in the bush frame
  double angle[2];       // pitch, roll [rad]
  double rate[2];        // [rad/s], of the tick, for the controller
  double mean_angle[2];  // half a period before: there the joints' differences are exact
  double mean_rate[2];
  double turning[2];  // what the gyroscope alone adds to the rates [rad/s]
  bool gyroscope;     // else rates come from the attitude
  SolePlace place;
};

}  // namespace plantar
