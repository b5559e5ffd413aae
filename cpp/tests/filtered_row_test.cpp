// The rows of both axes by what the filter passes: each number in its place and with its sign.
#include "online/filtered_row.hpp"

#include <algorithm>

#include "check.hpp"

namespace filtered_row_test {

using namespace plantar;

constexpr int ROLLS_STATE = FilteredRow::FIRST_AXIS + int(FilteredRow::AXIS_CHANNELS) + int(FilteredRow::ELEMENT);

struct Filtered {
  FilteredRow signals = {{0.5, 2.0, 300.0, 11.0, 13.0, 3300.0, 3900.0, 0.02,             // of both
                               0.03, 0.31, 0.33, 0.1, 0.2, 17.0, 19.0,                        // of pitch
                               0.05, 0.51, 0.53, 0.4, 0.7, 23.0, 29.0}};                      // of roll
  FootNoise noise{5.0};

  Filtered() {
    for (int a = 0; a < 2; ++a) noise.of_angle[a] = 1.0 + a, noise.of_rate[a] = 3.0 + a;
    for (int i = 0; i < 3; ++i) noise.of_force[i] = 5.0 + i;
  }
  RegressionRow row(int axis) const { return signals.of_axis(axis, noise); }
};

template <std::size_t SIZE>
void same(const double (&found)[SIZE], const double (&wanted)[SIZE], const char* what) {
  check::that(std::equal(found, found + SIZE, wanted), what);
}

void each_number_has_its_place() {
  const Filtered filtered;
  const RegressionRow pitch = filtered.row(0), roll = filtered.row(1);
  same(pitch.own, {0.5, 2.0, 0.0, 0.2}, "a constant, the time and the element's gap: pitch turns with no yaw torque");
  same(roll.own, {0.5, 2.0, 0.02, 0.7}, "roll does");
  same(pitch.columns, {0.03, 0.31, 0.1, 300.0, 11.0, 3300.0, -19.0, 0.33}, "columns of pitch");
  same(roll.columns, {0.05, 0.51, 0.4, 300.0, -13.0, -3900.0, -29.0, 0.53}, "columns of roll");
  check::that(pitch.torque == 17.0 && roll.torque == 23.0, "torques");
}

// An element that sticks goes with the angle's noise, and with the gyroscope's; what the filter makes of a constant is
// what a state of one would be. One that slips goes with neither, nor does one with an attitude's rates.
void noise_goes_where_the_element_follows_it() {
  Filtered filtered;
  const auto noise = [&](double state, bool gyroscope, const double (&wanted)[NOISE_SOURCES], const char* what) {
    filtered.signals.channels[ROLLS_STATE] = state, filtered.noise.gyroscope = gyroscope;
    same(filtered.row(1).noise, wanted, what);
    same(without_element(filtered.row(1)).noise, {2.0, 4.0, 0.0, 0.0, 5.0, 7.0}, "without an element");
  };
  for (const double sign : {1.0, -1.0}) {
    noise(sign * 0.494, true, {0.0, 0.0, 2.0, 4.0, 5.0, 7.0}, "it sticks");
    noise(sign * 0.494, false, {0.0, 4.0, 2.0, 0.0, 5.0, 7.0}, "without a gyroscope");
    noise(sign * 0.496, true, {2.0, 4.0, 0.0, 0.0, 5.0, 7.0}, "it slips");
  }
  check::that(filtered.row(0).noise[OF_HORIZONTAL] == 6.0, "each axis has its own force");
}

void without_an_element_all_else_stays() {
  const RegressionRow row = Filtered().row(1), bare = without_element(row);
  same(bare.own, {0.5, 2.0, 0.02, 0.0}, "no gap");
  same(bare.columns, {0.05, 0.51, 0.0, 300.0, -13.0, -3900.0, -29.0, 0.53}, "no state");
  check::that(bare.torque == row.torque, "the torque");
}

void run() {
  each_number_has_its_place();
  noise_goes_where_the_element_follows_it();
  without_an_element_all_else_stays();
}

const check::Listed listed(run);

}  // namespace filtered_row_test
