// Where the ground presses on a sole that is turned against its bush, read by a sensor that is turned, too.
#include <cmath>

#include "check.hpp"
#include "online/sole.hpp"

namespace sole_test {

using namespace plantar;

// Row-major, Rz(yaw) Ry(pitch) Rx(roll).
Frame frame(double yaw, double pitch, double roll, double x, double y, double z) {
  const double cy = std::cos(yaw), sy = std::sin(yaw), cp = std::cos(pitch), sp = std::sin(pitch);
  const double cr = std::cos(roll), sr = std::sin(roll);
  return {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, sy * cp, sy * sp * sr + cy * cr,
           sy * sp * cr - cy * sr, -sp, cp * sr, cp * cr},
          {x, y, z}};
}

// A force at one point of the sole and a twist about its normal are all that the ground does.
void the_ground_presses_where_its_force_passes() {
  const Frame sole = frame(0.4, -0.2, 0.3, 0.02, -0.01, -0.1), sensor = frame(-0.7, 0.5, 0.2, 0.01, 0.03, 0.05);
  const Frame bent = frame(0.0, 0.06, -0.04, 0.0, 0.0, 0.0);  // by pitch, then roll, about the bush's centre
  const double pressed[3] = {0.05, -0.03, 0.0}, force[3] = {30.0, -20.0, 400.0}, twist[3] = {0.0, 0.0, 7.0};
  const double sign = -1.0, up[3] = {bent.rotation[2], bent.rotation[5], bent.rotation[8]};
  const auto in_bush = [&](const double* v) { return rotated(bent.rotation, rotated(sole.rotation, v).data()); };
  const Vector3 within = rotated(sole.rotation, pressed);
  const double undeflected[3] = {within[0] + sole.origin[0], within[1] + sole.origin[1], within[2] + sole.origin[2]};
  const Vector3 at = rotated(bent.rotation, undeflected), pushes = in_bush(force), twists = in_bush(twist);
  const double arm[3] = {at[0] - sensor.origin[0], at[1] - sensor.origin[1], at[2] - sensor.origin[2]};
  const Vector3 moment = cross(arm, pushes.data());
  const double turns[3] = {moment[0] + twists[0], moment[1] + twists[1], moment[2] + twists[2]};
  double reads[6];
  for (int i = 0; i < 3; ++i) {
    reads[i] = reads[3 + i] = 0.0;
    for (int j = 0; j < 3; ++j) {
      reads[i] += sign * sensor.rotation[3 * j + i] * pushes[j];
      reads[3 + i] += sign * sensor.rotation[3 * j + i] * turns[j];
    }
  }
  const auto wrench = moved_wrench(sensor, sign, reads);
  for (int i = 0; i < 3; ++i) check::near(wrench[i], pushes[i], 1e-10, "the ground's force in the bush's frame");
  Point centre = {1.0, 1.0};
  check::that(centre_of_pressure(wrench, Bend(up), sole, 399.0, centre), "the normal force is enough");
  for (int i = 0; i < 2; ++i) check::near(centre[i], pressed[i], 1e-12, "where the ground presses");
  check::that(!centre_of_pressure(wrench, Bend(up), sole, 401.0, centre), "a light foot has no such place");
}

void a_bend_is_what_turns_the_normal_up() {
  const Frame bent = frame(0.0, 0.5, -0.3, 0.0, 0.0, 0.0);
  const Bend bend(std::array<double, 3>{bent.rotation[2], bent.rotation[5], bent.rotation[8]}.data());
  check::near(bend.sin_pitch, std::sin(0.5), 1e-12, "sine of pitch");
  check::near(bend.cos_pitch, std::cos(0.5), 1e-12, "cosine of pitch");
  check::near(bend.sin_roll, std::sin(-0.3), 1e-12, "sine of roll");
  check::near(bend.cos_roll, std::cos(-0.3), 1e-12, "cosine of roll");
}

// An outline whose corners are not about its origin.
void how_deep_a_point_lies_is_to_its_nearest_side() {
  const Outline outline({{0.3, 0.1}, {0.3, 0.2}, {0.1, 0.2}, {0.1, 0.1}});
  check::near(outline.depth({0.12, 0.16}), 0.02, 1e-12, "inside, the nearest side");
  check::near(outline.depth({0.2, 0.23}), -0.03, 1e-12, "outside");
  check::near(outline.middle_depth(), 0.05, 1e-12, "in the middle");
}

void run() {
  the_ground_presses_where_its_force_passes();
  a_bend_is_what_turns_the_normal_up();
  how_deep_a_point_lies_is_to_its_nearest_side();
}

const check::Listed listed(run);

}  // namespace sole_test
