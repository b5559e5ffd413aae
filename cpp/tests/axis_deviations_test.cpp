// Deviations of one axis where they have a closed form: groups of one whole period each, in which angle, rate and what a
// delay adds are orthogonal.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "check.hpp"
#include "online/axis_regression.hpp"

namespace axis_deviations_test {

using namespace plantar;

constexpr double ROW = 0.025, STIFF = 800.0, DAMPS = 20.0, ANGLE = 0.01, LATER = 3.0;  // s; LATER: size of its column
constexpr int ROWS = 80, GROUPS = 6;
using OfGroups = std::array<double, GROUPS>;

// more: stiffness beyond STIFF in each group; delay: of each [s]; noise: of the torque [N·m].
AxisValues after(const OfGroups& more, const OfGroups& delay, double noise, double noise_time = ROW) {
  const RegressionPrior prior = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                                 {}, {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0,
                                 noise_time};
  AxisRegression axis(prior);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int g = 0; g < GROUPS; ++g) {
    for (int i = 0; i < ROWS; ++i) {
      const double t = ROW * (ROWS * g + i), turn = 2.0 * std::numbers::pi * (i + 0.5) / ROWS;
      const double angle = ANGLE * std::cos(turn), rate = 0.03 * std::sin(turn), late = LATER * std::cos(2.0 * turn);
      RegressionRow row = {{1.0, t}, {angle, rate, 0.0, 0.0, 0.0, 0.0, late}, 0.0, {}};
      row.torque = (STIFF + more[g]) * angle + DAMPS * rate + delay[g] * late + noise * normal(random);
      axis.add(row, ROW), axis.work();
    }
    axis.close();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  return axis.values();
}

// Of a mean of values that are alike but for chance.
double standard_error(const OfGroups& values) {
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / GROUPS;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / GROUPS / (GROUPS - 1));
}

// Leaving out one group after the other is, for groups that weigh the same, the standard error of their mean.
void groups_that_differ_leave_their_standard_error() {
  const OfGroups more = {6.0, -4.0, 2.0, -8.0, 10.0, -6.0}, delay = {1e-3, 4e-3, -2e-3, 3e-3, 0.0, 0.0};
  const AxisValues found = after(more, delay, 0.0);
  check::that(found.groups == GROUPS, "a group a period");
  check::near(found.value[STIFFNESS], STIFF, 0.01, "the groups' mean");
  check::near(found.grouped[STIFFNESS], standard_error(more), 0.01 * standard_error(more), "of the stiffness");
  check::near(found.late.value, 1e-3, 1e-6, "the mean delay");
  check::near(found.late.grouped, standard_error(delay), 0.01 * standard_error(delay), "of the delay");
}

// White noise leaves its deviation over the root of each column's squares; noise that hangs together for four rows, twice
// of that.
void white_noise_leaves_what_columns_cannot_tell_from_it() {
  constexpr double NOISE = 0.05;
  const double half = GROUPS * ROWS / 2.0;  // of the squares of a sine
  for (const double together : {1.0, 4.0}) {
    const AxisValues found = after({}, {}, NOISE, together * ROW);
    const double of_angle = NOISE * std::sqrt(together / half) / ANGLE, of_late = NOISE * std::sqrt(together / half) / LATER;
    check::near(found.white[STIFFNESS], of_angle, 0.1 * of_angle, "of the stiffness by the rows' scatter");
    check::near(found.late.white, of_late, 0.1 * of_late, "of the delay by the rows' scatter");
    check::that(found.told[STIFFNESS] < 1e-2 * of_angle, "the prior says nothing");
  }
}

// Noise of a force that reaches the torque through the sensor's place is taken off each group as much as it is there:
// groups that differ in it alone do not differ in their values.
void noise_that_differs_between_groups_is_no_difference() {
  RegressionPrior prior = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                           {}, {6e4, 6e4, 600.0, 1e-9, 0.1, 1e-12, 1e-9, 1e-9}, 0.0, 1.0, 0.0, 0.0, 0.05, 0.0, ROW};
  AxisRegression axis(prior);
  for (int g = 0; g < GROUPS; ++g) {
    const double size = g % 2 == 0 ? 0.0 : 2.0;
    for (int i = 0; i < ROWS; ++i) {
      const double t = ROW * (ROWS * g + i), turn = 2.0 * std::numbers::pi * (i + 0.5) / ROWS;
      const double angle = ANGLE * std::cos(turn), rate = 0.03 * std::sin(turn), noise = i % 2 == 0 ? size : -size;
      RegressionRow row = {{1.0, t}, {angle, rate, 0.0, 0.0, 10.0 * std::cos(3.0 * turn) + noise}, 0.0, {}};
      row.torque = STIFF * angle + DAMPS * rate + prior.horizontal_arm * noise;
      row.noise[OF_HORIZONTAL] = size * size;
      axis.add(row, ROW), axis.work();
    }
    axis.close();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  check::near(axis.values().value[ABOVE], 0.0, 5e-5, "the place is where it was told to be");
  check::near(axis.values().grouped[ABOVE], 0.0, 5e-5, "and all groups say so");
}

void run() {
  groups_that_differ_leave_their_standard_error();
  white_noise_leaves_what_columns_cannot_tell_from_it();
  noise_that_differs_between_groups_is_no_difference();
}

const check::Listed listed(run);

}  // namespace axis_deviations_test
