// Stiffness and damping from rows with noise: no attenuation, deviations that hold, a memory that fades.
#include "online/axis_regression.hpp"

#include <cmath>
#include <random>

#include "check.hpp"

namespace axis_regression_test {

using namespace plantar;

constexpr double ROW = 0.025;  // s
constexpr double DAMPING_TRUTH = 20.0;

RegressionPrior prior() {
  return {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
          {},
          {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9},
          0.0,
          1.0,
          0.0,
          0.0,
          0.0,
          0.0,
          ROW};
}

struct Source {
  explicit Source(unsigned seed) : random(seed) {}

  RegressionRow row(double t, double stiffness, double angle_noise, double torque_noise) {
    const double angle = 0.01 * std::sin(2.0 * t), rate = 0.02 * std::cos(2.0 * t);
    const double torque = stiffness * angle + DAMPING_TRUTH * rate + 1.0 + torque_noise * normal(random);
    return {{1.0, t, 0.0}, {angle + angle_noise * normal(random), rate}, torque, {angle_noise * angle_noise, 0.0, 0.0}};
  }

  std::mt19937 random;
  std::normal_distribution<double> normal;
};

AxisValues after(AxisRegression& axis, Source& source, double from, double seconds, double stiffness,
                 double angle_noise, double torque_noise) {
  for (int i = 0; i < static_cast<int>(seconds / ROW); ++i) {
    axis.add(source.row(from + ROW * i, stiffness, angle_noise, torque_noise), ROW);
    axis.work();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  return axis.values();
}

void noise_of_the_angle_draws_nothing_to_zero() {
  double mean = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    AxisRegression axis(prior());
    Source source(seed);
    mean += after(axis, source, 0.0, 100.0, 800.0, 0.003, 0.0).value[STIFFNESS] / 10;
  }
  check::near(mean, 800.0, 8.0, "stiffness beside noise of a third of the motion, which alone would take off 15 %");
}

// Of the noise in a short stance a good part is in its offset, where it draws nothing to zero.
void what_an_offset_has_taken_is_not_taken_off_again() {
  double mean = 0.0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    AxisRegression axis(prior());
    Source source(seed);
    for (int i = 0; i < 8000; ++i) {
      axis.add(source.row(2.0 * ROW * i, 800.0, 0.002, 0.0), ROW);
      axis.work();
      if (i % 10 == 9) axis.close();
    }
    for (int i = 0; i < 4; ++i) axis.work();
    mean += axis.values().value[STIFFNESS] / 8;
  }
  check::near(mean, 800.0, 16.0, "stiffness from stances of ten rows");
}

// Of `trials` runs of `seconds`: the narrowest told deviation, the mean one, and the scatter of what was found.
struct Told {
  double least = 1e9, mean = 0.0, scatter = 0.0;

  Told(unsigned trials, double seconds) {
    for (unsigned seed = 0; seed < trials; ++seed) {
      AxisRegression axis(prior());
      Source source(seed);
      const AxisValues found = after(axis, source, 0.0, seconds, 800.0, 0.0, 0.5);
      scatter += (found.value[STIFFNESS] - 800.0) * (found.value[STIFFNESS] - 800.0) / trials;
      mean += found.std[STIFFNESS] / trials;
      least = std::min(least, found.std[STIFFNESS]);
    }
    scatter = std::sqrt(scatter);
  }
};

// Three groups may agree by chance; noise that is seen in the rows leaves its deviation however well they do.
void groups_that_agree_by_chance_say_nothing() {
  const Told told(100, 9.0);
  check::that(told.least > 0.7 * told.scatter, "the narrowest deviation of a hundred");
}

void deviations_hold() {
  const Told told(60, 60.0);
  check::that(told.mean > 0.7 * told.scatter && told.mean < 1.5 * told.scatter, "the told deviation is the scatter");
}

void what_was_long_ago_fades_and_rest_forgets_nothing() {
  AxisRegression axis(prior());
  Source source(1);
  after(axis, source, 0.0, 400.0, 800.0, 0.0, 0.05);
  const AxisValues learnt = axis.values();
  // Twelve groups of 8 s hold somewhat less than two fillings each: 48 s are a quarter of what is remembered.
  check::near(after(axis, source, 400.0, 48.0, 880.0, 0.0, 0.05).value[STIFFNESS], 818.0, 2.0, "and not at once");
  check::near(after(axis, source, 448.0, 352.0, 880.0, 0.0, 0.05).value[STIFFNESS], 880.0, 8.0,
              "a slow change is followed");

  AxisRegression resting(prior());
  Source again(1);
  after(resting, again, 0.0, 400.0, 800.0, 0.0, 0.05);
  for (int i = 0; i < 40000; ++i) {  // a thousand seconds at rest, with noise
    const double noise = 1e-6 * again.normal(again.random);
    resting.add({{1.0, ROW * i, 0.0}, {noise, 10 * noise}, 1.0 + 0.05 * again.normal(again.random), {1e-12, 0.0, 0.0}},
                ROW);
    resting.work();
  }
  check::near(resting.values().value[STIFFNESS], learnt.value[STIFFNESS], 0.5, "rest leaves the value");
  check::that(resting.values().std[STIFFNESS] < 2.0 * learnt.std[STIFFNESS], "and what is known of it");
}

void offsets_are_each_stances_own() {
  AxisRegression axis(prior());
  Source source(2);
  for (int stance = 0; stance < 60; ++stance) {
    for (int i = 0; i < 30; ++i) {
      const double t = stance + ROW * i;
      RegressionRow row = source.row(t, 800.0, 0.0, 0.0);
      row.torque += 3.0 * (stance % 2) + 0.05 * stance;
      axis.add(row, ROW);
      axis.work();
    }
    axis.close();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  check::near(axis.values().value[STIFFNESS], 800.0, 1e-3, "stiffness beside offsets that differ");
  check::near(axis.values().value[DAMPING], DAMPING_TRUTH, 1e-3, "damping beside offsets that differ");
}

// In blocks that are shorter than the motion is slow, offset and drift would take most of it.
void slow_motions_tell_the_stiffness() {
  double squares = 0.0;
  constexpr int TRIALS = 20;
  for (unsigned seed = 0; seed < TRIALS; ++seed) {
    AxisRegression axis(prior());
    Source source(seed);
    for (int i = 0; i < 1800; ++i) {
      const double t = ROW * i, angle = 0.004 * std::sin(0.7 * t), rate = 0.0028 * std::cos(0.7 * t);
      const double torque = 800.0 * angle + DAMPING_TRUTH * rate + 0.3 * source.normal(source.random);
      axis.add({{1.0, t, 0.0}, {angle, rate}, torque, {}}, ROW);
      axis.work();
    }
    for (int i = 0; i < 4; ++i) axis.work();
    const double off = axis.values().value[STIFFNESS] - 800.0;
    squares += off * off / TRIALS;
  }
  check::that(std::sqrt(squares) < 3.0, "stiffness from slow motions");
}

// A block that says something else has moved the value before any group tells by how much they differ.
void a_block_that_moves_the_value_widens_it() {
  AxisRegression axis(prior());
  Source source(5);
  after(axis, source, 0.0, 100.0, 800.0, 0.0, 0.01);
  axis.close();
  const AxisValues learnt = after(axis, source, 100.0, 0.0, 800.0, 0.0, 0.01);
  const AxisValues moved = after(axis, source, 100.0, 5.0, 850.0, 0.0, 0.01);
  const double off = moved.value[STIFFNESS] - learnt.value[STIFFNESS];
  check::that(off > 10.0 * learnt.std[STIFFNESS], "other rows move the value");
  check::near(moved.moved[STIFFNESS], off, 0.5 * off, "and say so");
}

// Another drift and another zero of the yaw torque in each recording, as large as the regression allows for, beside a
// motion as slow as a block is long.
void what_differs_between_blocks_moves_nothing() {
  RegressionPrior known = prior();
  known.twist = 1.0;
  AxisRegression axis(known);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4800; ++i) {
    const double t = ROW * i, sign = i < 2400 ? 1.0 : -1.0;
    const double angle = 0.004 * std::sin(0.5 * t), rate = 0.002 * std::cos(0.5 * t);
    const double pitch = 0.02 * (std::sin(0.5 * t) + std::sin(1.3 * t));
    const double torque = 800.0 * angle + DAMPING_TRUTH * rate + sign * (0.02 * t + 0.8 * pitch);
    if (i == 2400) axis.close();
    axis.add({{1.0, t, pitch}, {angle, rate}, torque + 0.01 * normal(random), {}}, ROW);
    axis.work();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  check::near(axis.values().value[STIFFNESS], 800.0, 1.0, "stiffness beside drift and twist");
  check::near(axis.values().value[DAMPING], DAMPING_TRUTH, 2.0, "damping beside drift and twist");
}

// The force's noise is in the columns of the bush's place, and through the sensor's place in the torque. One that goes
// with the motion tells the place badly; another would by its noise move it by 4 mm.
void noise_of_forces_moves_nothing(Unknown column, NoiseSource of_force, bool with_motion) {
  double mean = 0.0, place = 0.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    RegressionPrior known = prior();
    known.spread[column] = with_motion ? 0.01 : 0.1;
    (of_force == OF_LOAD ? known.load_arm : known.horizontal_arm) = 0.05;
    AxisRegression axis(known);
    Source source(seed);
    for (int i = 0; i < 4000; ++i) {
      const double t = ROW * i, noise = 2.0 * source.normal(source.random);
      RegressionRow row = source.row(t, 800.0, 0.0, 0.0);
      const double force = with_motion ? 3.0 * std::sin(2.0 * t + 0.5) + std::sin(3.1 * t) : 10.0 * std::sin(3.1 * t);
      row.torque += 0.003 * force + 0.05 * noise;
      row.columns[column] = force + noise;
      row.noise[of_force] = 4.0;
      axis.add(row, ROW);
      axis.work();
    }
    for (int i = 0; i < 4; ++i) axis.work();
    mean += axis.values().value[STIFFNESS] / 10, place += axis.values().value[column] / 10;
  }
  check::near(mean, 800.0, 3.0, "stiffness beside a force with noise, which alone would take 11 off");
  if (!with_motion) check::near(place, 0.003, 4e-4, "place of the bush beside a force with noise");
}

// Under a load that changes, and when most of what was learnt has been forgotten again, a weak force's noise is still
// taken off as much as it is there.
void noise_under_changing_loads_moves_nothing(double seconds, const char* what) {
  double mean = 0.0, compliance = 0.0;
  for (unsigned seed = 0; seed < 5; ++seed) {
    RegressionPrior known = prior();
    known.spread[COMPLIANCE] = 1e-2;
    AxisRegression axis(known);
    Source source(seed);
    for (int i = 0; i < static_cast<int>(seconds / ROW); ++i) {
      const double t = ROW * i, noise = 2.0 * source.normal(source.random),
                   load = 300.0 * (1.0 + 0.9 * std::sin(0.3 * t));
      RegressionRow row = source.row(t, 800.0, 0.0, 0.02);
      const double force = 3.0 * std::sin(2.0 * t + 0.5) + std::sin(3.1 * t);
      row.torque += 1e-3 * load * force;
      row.columns[ASIDE] = load, row.columns[COMPLIANCE] = load * (force + noise);
      row.noise[OF_HORIZONTAL] = 4.0;
      axis.add(row, ROW);
      axis.work();
    }
    for (int i = 0; i < 4; ++i) axis.work();
    mean += axis.values().value[STIFFNESS] / 5, compliance += axis.values().value[COMPLIANCE] / 5;
  }
  check::near(mean, 800.0, 8.0, what);
  check::near(compliance, 1e-3, 1e-4, what);
}

// A slide that the load compresses moves the centre with it.
void the_compliance_is_learnt() {
  RegressionPrior known = prior();
  known.spread[COMPLIANCE] = 1e-5;
  AxisRegression axis(known);
  Source source(4);
  for (int i = 0; i < 4000; ++i) {
    const double t = ROW * i, load = 300.0 + 200.0 * std::sin(0.7 * t), force = 30.0 * std::sin(3.1 * t);
    RegressionRow row = source.row(t, 800.0, 0.0, 0.02);
    row.columns[COMPLIANCE] = load * force;
    row.torque += 4e-6 * load * force;
    axis.add(row, ROW);
    axis.work();
  }
  for (int i = 0; i < 4; ++i) axis.work();
  check::near(axis.values().value[COMPLIANCE], 4e-6, 1e-7, "compliance of the slide");
  check::near(axis.values().value[STIFFNESS], 800.0, 0.5, "stiffness beside it");
}

// A foot that hardly moves, and then does: the block that is open moves the value far, before any group has told by how
// much they differ. Nothing is compared with that.
void a_motion_that_begins_is_no_other_ground() {
  int jumps = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    AxisRegression axis(prior());
    Source source(seed);
    for (int i = 0; i < 1200; ++i) {
      const double t = ROW * i, size = t < 21.0 ? 3e-4 : 4e-3;
      const double angle = size * std::sin(1.5 * t), rate = 1.5 * size * std::cos(1.5 * t);
      const double noise = 1e-4 * source.normal(source.random), torque_noise = 0.02 * source.normal(source.random);
      axis.add({{1.0, t}, {angle + noise, rate}, 800.0 * angle + DAMPING_TRUTH * rate + torque_noise, {1e-7}}, ROW);
      axis.work();
      jumps += axis.jumped();
    }
  }
  check::that(jumps == 0, "no jump");
}

// A torque whose sign turns for some seconds is no ground; nothing of it is learnt.
void what_no_ground_does_is_thrown_away() {
  AxisRegression axis(prior());
  Source source(7);
  after(axis, source, 0.0, 60.0, 800.0, 0.0, 0.01);
  check::that(!axis.doubted(), "nothing to doubt");
  int doubted = 0;
  for (int i = 0; i < 160; ++i) {
    RegressionRow row = source.row(60.0 + ROW * i, 800.0, 0.0, 0.01);
    row.torque *= -1.0;
    axis.add(row, ROW);
    axis.work();
    doubted += axis.doubted();
  }
  check::that(doubted > 80, "a torque of the other sign");
  const AxisValues found = after(axis, source, 64.0, 20.0, 800.0, 0.0, 0.01);
  check::that(!axis.doubted() && !axis.jumped(), "believed again, and the ground is the same");
  check::near(found.value[STIFFNESS], 800.0, 0.5, "stiffness behind it");
}

void run() {
  a_motion_that_begins_is_no_other_ground();
  what_no_ground_does_is_thrown_away();
  slow_motions_tell_the_stiffness();
  a_block_that_moves_the_value_widens_it();
  what_differs_between_blocks_moves_nothing();
  noise_of_forces_moves_nothing(ABOVE, OF_HORIZONTAL, true);
  noise_of_forces_moves_nothing(ABOVE, OF_HORIZONTAL, false);
  noise_of_forces_moves_nothing(ASIDE, OF_LOAD, false);
  noise_under_changing_loads_moves_nothing(80.0, "beside noise under a changing load");
  noise_under_changing_loads_moves_nothing(400.0, "the same, when older data have faded");
  the_compliance_is_learnt();
  noise_of_the_angle_draws_nothing_to_zero();
  what_an_offset_has_taken_is_not_taken_off_again();
  groups_that_agree_by_chance_say_nothing();
  deviations_hold();
  what_was_long_ago_fades_and_rest_forgets_nothing();
  offsets_are_each_stances_own();
}

const check::Listed listed(run);

}  // namespace axis_regression_test
