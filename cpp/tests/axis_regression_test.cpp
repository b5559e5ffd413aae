// Stiffness and damping from rows with noise: no attenuation, deviations that hold, a memory that fades.
#include "online/axis_regression.hpp"

#include <random>

#include "check.hpp"

using namespace plantar;

namespace {

constexpr double ROW = 0.025;  // s
constexpr double DAMPING_TRUTH = 20.0;

RegressionPrior prior() { return {{0.01, 0.1, 1.0, 600.0, 60.0}, {}, {6e4, 6e4, 600.0, 1e-9, 1e-9}, 0.0}; }

struct Source {
  explicit Source(unsigned seed) : random(seed) {}

  RegressionRow row(double t, double stiffness, double angle_noise, double torque_noise) {
    const double angle = 0.01 * std::sin(2.0 * t), rate = 0.02 * std::cos(2.0 * t);
    const double torque = stiffness * angle + DAMPING_TRUTH * rate + 1.0 + torque_noise * normal(random);
    return {1.0,
            {angle + angle_noise * normal(random), rate, 0.0, 0.0, 0.0},
            torque,
            {angle_noise * angle_noise, 0.0, 0.0}};
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

void deviations_hold() {
  double squares = 0.0, told = 0.0;
  constexpr int TRIALS = 60;
  for (unsigned seed = 0; seed < TRIALS; ++seed) {
    AxisRegression axis(prior());
    Source source(seed);
    const AxisValues found = after(axis, source, 0.0, 60.0, 800.0, 0.0, 0.5);
    squares += (found.value[STIFFNESS] - 800.0) * (found.value[STIFFNESS] - 800.0) / TRIALS;
    told += found.std[STIFFNESS] / TRIALS;
  }
  check::that(told > 0.7 * std::sqrt(squares) && told < 1.5 * std::sqrt(squares), "the told deviation is the scatter");
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
    resting.add({1.0, {noise, 10 * noise, 0.0, 0.0, 0.0}, 1.0 + 0.05 * again.normal(again.random), {1e-12, 0.0, 0.0}},
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

}  // namespace

int main() {
  noise_of_the_angle_draws_nothing_to_zero();
  deviations_hold();
  what_was_long_ago_fades_and_rest_forgets_nothing();
  offsets_are_each_stances_own();
  return check::result();
}
