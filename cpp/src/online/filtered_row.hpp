// What the filter passes of a foot's signals, and the row of each axis' regression that it makes.
#pragma once

#include <cmath>

#include "online/axis_regression.hpp"
#include "online/foot_noise.hpp"

namespace plantar {

constexpr double HARDLY_SLIPS = 0.99;  // of an element's largest state: below it noise moves it as the deflection

struct FilteredRow {
  static constexpr int CHANNELS = 22;
  // Constant, time, load, horizontal forces, the load times each, what turns with the pitch; then of each axis.
  enum Channel : int { ONE, TIME, LOAD, FORCE_X, FORCE_Y, LOAD_X, LOAD_Y, TURN, FIRST_AXIS };
  enum AxisChannel : int { ANGLE, ANGLE_RATE, TURNING, ELEMENT, GAP, TORQUE, TORQUE_RATE, AXIS_CHANNELS };

  double channels[CHANNELS];

  // Of an axis beside whose bush there is an element. A centre that is higher takes its share of the horizontal force:
  // F_x off the pitch torque, F_y onto the roll torque.
  RegressionRow of_axis(int axis, const FootNoise& noise) const noexcept {
    const double *c = channels, *own = c + FIRST_AXIS + int(AXIS_CHANNELS) * axis;
    const double across = axis == 0 ? c[FORCE_X] : -c[FORCE_Y], loaded = axis == 0 ? c[LOAD_X] : -c[LOAD_Y];
    const bool sticks = std::abs(own[ELEMENT]) < HARDLY_SLIPS * c[ONE];
    RegressionRow row = {
        {c[ONE], c[TIME], axis == 1 ? c[TURN] : 0.0, own[GAP]},
        {own[ANGLE], own[ANGLE_RATE], own[ELEMENT], c[LOAD], across, loaded, -own[TORQUE_RATE], own[TURNING]},
        own[TORQUE],
        {0.0, 0.0, 0.0, 0.0, noise.of_force[0], noise.of_force[1 + axis]}};
    row.noise[sticks ? OF_ANGLE_AND_ELEMENT : OF_ANGLE] = noise.of_angle[axis];
    row.noise[sticks && noise.gyroscope ? OF_RATE_AND_ELEMENT : OF_RATE] = noise.of_rate[axis];
    return row;
  }
};

// The same row where there is none.
inline RegressionRow without_element(RegressionRow row) noexcept {
  row.columns[SLIP_TORQUE] = row.own[BEGINNING] = 0.0;
  row.noise[OF_ANGLE] += row.noise[OF_ANGLE_AND_ELEMENT], row.noise[OF_RATE] += row.noise[OF_RATE_AND_ELEMENT];
  row.noise[OF_ANGLE_AND_ELEMENT] = row.noise[OF_RATE_AND_ELEMENT] = 0.0;
  return row;
}

}  // namespace plantar
