// How large a contradiction between gyroscope and attitude must be, and how soon it is told; how much the feet's load
// may be off.
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "check.hpp"
#include "online/contradiction.hpp"

namespace turn_watch_test {

using namespace plantar;

constexpr double PERIOD = 0.005, WEIGHT = 500.0;                  // s, N
constexpr double FOLLOWS = 1.0 / (2.0 * std::numbers::pi * 1.5);  // s: time constant of the band
using Rates = std::function<std::array<double, 3>(double)>;

// A chest turns as `turns` says [rad/s about its own axes], the gyroscope reads `reads`, and the attitude has noise;
// the IMU is mounted with no axis along the chest's. When they differ [s], over all samples.
struct Told {
  double first = -1.0, last = -1.0, whole = 0.0;
};
Told differ(const Rates& turns, const Rates& reads, double from, double end, double noise = 0.0) {
  // Rows: the IMU's axes in the chest.
  constexpr double MOUNT[3][3] = {{0.36, -0.8, 0.48}, {0.48, 0.6, 0.64}, {-0.8, 0.0, 0.6}};
  TurnWatch watch;
  Told told;
  std::array<double, 3> up = {0.0, 0.0, 1.0};
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (double time = 0.0; time < end; time += PERIOD) {
    const auto mean = turns(time - 0.5 * PERIOD), read = reads(time - 0.5 * PERIOD);
    for (int part = 0; part < 20; ++part) {
      const std::array<double, 3> u = up;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        up[i] += (u[j] * mean[k] - u[k] * mean[j]) * PERIOD / 20.0;
      }
    }
    double seen[3] = {}, rate[3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) seen[i] += MOUNT[i][j] * up[j], rate[i] += MOUNT[i][j] * read[j];
    for (double& each : seen) each += noise * normal(random);
    if (!watch.differ({seen[0], seen[1], seen[2]}, rate, PERIOD) || time < from) continue;
    if (told.first < 0.0) told.first = time - from;
    told.last = time - from, told.whole += PERIOD;
  }
  return told;
}

constexpr double BEGIN = 30.0;  // s, from which on the gyroscope reads `gain` times what turns

Rates sways(double size) {
  return [size](double t) {
    return std::array<double, 3>{size * std::sin(3.0 * t), size * std::cos(4.0 * t), 0.7 * size * std::sin(2.0 * t)};
  };
}
// Two axes turn from `BEGIN` on for `lasts`, yaw all the time.
Rates steady(double size, double lasts = 3.0) {
  return [size, lasts](double t) {
    const double now = t > BEGIN && t < BEGIN + lasts ? size : 0.0;
    return std::array<double, 3>{0.6 * now, 0.8 * now, 0.02};
  };
}
Rates times(const Rates& turns, double gain) {
  return [turns, gain](double t) {
    auto read = turns(t);
    if (t > BEGIN)
      for (double& each : read) each *= gain;
    return read;
  };
}
Told with_gain(const Rates& turns, double gain, double end, double noise = 0.0) {
  return differ(turns, times(turns, gain), BEGIN, end, noise);
}

// Half of the larger of both: an attitude that turns half as much again, or a gyroscope that turns twice as much, not
// yet.
void gains_differ_beyond_a_half() {
  for (const double gain : {0.55, 1.0, 1.9}) check::that(with_gain(sways(0.3), gain, 40.0).whole == 0.0, "gains");
  for (const double gain : {0.45, 2.1})
    check::that(with_gain(sways(0.3), gain, 40.0).whole > 9.0, "no gain makes that");
}

// Both turns come through the same low-pass; how long until their difference is large enough, and stays so.
void larger_differences_are_told_sooner() {
  const auto first = [](double size, double gain) { return with_gain(steady(size), gain, 33.0, 1e-5).first; };
  const double share = 0.5 * std::log(1.0 / 0.7);  // s: three tenths of half a second
  check::near(first(0.1, 0.3), share, 0.015, "less than nine tenths of the larger: a share of the time");
  check::near(first(0.1, 0.0), FOLLOWS * std::log(1.0 / (1.0 - 0.54)), 0.01, "more: at once, from 54 mrad/s on");
  check::near(first(0.04, -1.0), FOLLOWS * std::log(1.0 / (1.0 - 0.54 / 0.8)), 0.01, "slowly");
}

void small_differences_are_none() {
  const auto told = [](double size, double noise, double lasts) {
    return with_gain(steady(size, lasts), 0.0, 33.0, noise).whole > 0.3;
  };
  check::that(!told(0.0045, 5e-5, 0.5) && told(0.0065, 5e-5, 0.5), "5 mrad/s spoil no damping");
  // Four deviations of a rate behind the band, of three axes.
  const double noise = 4.0 * std::sqrt(3.0) * 1e-3 / FOLLOWS;
  check::that(!told(0.9 * noise, 1e-3, 1.0) && told(1.2 * noise, 1e-3, 1.0), "more than the attitude's noise");
}

// The attitude's noise makes mean squares of its own: a gyroscope that stands is told beside turns of twice as much.
void turns_are_seen_beside_the_noise() {
  constexpr double NOISE = 1e-3, PACE = 6.0;
  const auto stands = [](double) { return std::array<double, 3>{}; };
  const auto told = [&](double power) {
    const double left = 1.0 / (1.0 + PACE * PACE * FOLLOWS * FOLLOWS);
    const double size = NOISE / FOLLOWS * std::sqrt(3.0 * 2.0 * power / left);
    const Rates turns = [=](double t) { return std::array<double, 3>{0.0, size * std::cos(PACE * t), 0.0}; };
    return differ(turns, stands, 30.0, 60.0, NOISE).whole;
  };
  check::that(told(1.6) == 0.0 && told(2.6) > 29.9, "turns of twice the noise's mean square");
  check::near(differ(sways(0.003), stands, 0.0, 4.0, 1e-5).first, 2.0, 0.03, "small ones need two seconds");
}

// A reading that no chest turns as fast as echoes as the fastest turn does.
void one_reading_echoes_no_longer_than_the_fastest_turn() {
  const auto stands = [](double) { return std::array<double, 3>{}; };
  const auto echo = [&](double reading) {
    const Rates leaps = [=](double t) {
      return std::array<double, 3>{0.0, t > BEGIN && t < BEGIN + 1.01 * PERIOD ? reading : 0.0, 0.0};
    };
    return differ(stands, leaps, BEGIN, 32.0).whole;
  };
  check::near(echo(50.0), echo(4.3), 1e-9, "of three axes, each beyond 1.5 rad/s");
  check::that(echo(2.0) < echo(4.3), "or within");
}

void a_fault_moves_the_zero_by_little() {
  const Rates stands = [](double) { return std::array<double, 3>{}; };
  const Rates faulty = [](double t) {
    return std::array<double, 3>{0.0, t > BEGIN && t < BEGIN + 6.0 ? 0.04 : 0.0, 0.0};
  };
  check::that(differ(stands, faulty, BEGIN, BEGIN + 50.0, 2e-4).last < 7.0, "by 5 mrad/s in six seconds, and is over");
}

void a_usual_load_is_followed() {
  const auto differs = [](WeightWatch& watch, double share, double lasts, int unknown = 0) {
    bool told = false;
    for (int tick = 0; tick < lasts / PERIOD; ++tick) told = watch.differs(share * WEIGHT, unknown, PERIOD);
    return told;
  };
  WeightWatch steps(WEIGHT);
  const double until = 0.4 * std::log(0.25 / 0.1);  // s, until a quarter less has become 15 % less
  check::that(!differs(steps, 0.75, until - 0.02) && differs(steps, 0.75, 0.04), "a step's accelerations cancel");
  steps.restart();
  check::that(!differs(steps, 1.0, PERIOD), "begun anew");
  for (const double sign : {-1.0, 1.0}) {
    WeightWatch mass(WEIGHT);
    check::that(!differs(mass, 1.0 + sign * 0.13, 20.0), "a mass that is wrong by 13 %");
    const double usual = 1.0 + sign * 0.13 * (1.0 - std::exp(-1.0));
    check::that(!differs(mass, usual + sign * 0.14, 2.0), "has become usual by two thirds in twenty seconds");
    check::that(differs(mass, usual + sign * 0.19, 2.0), "and no more");
    for (const double share : {0.13, 0.24, 0.3}) differs(mass, 1.0 + sign * share, 100.0);
    check::that(!differs(mass, 1.0 + sign * 0.34, 2.0) && differs(mass, 1.0 + sign * 0.36, 2.0), "20 % at most");
    WeightWatch unknown(WEIGHT);
    check::that(!differs(unknown, 1.0 + sign * 0.13, 60.0, 1), "of a foot whose zero is unknown");
    check::that(differs(unknown, 1.0 + sign * 0.2, 2.0), "nothing becomes usual");
  }
}

// A still attitude beside a gyroscope that sways, at once or by little for long; then readings were missing.
void what_differed_before_a_pause_is_forgotten() {
  for (const double size : {0.06, 0.004}) {
    TurnWatch watch;
    bool told = false;
    double time = 0.0;
    for (; time < 20.0; time += PERIOD) {
      const double rate[3] = {size * std::sin(3.0 * time), size * std::cos(4.0 * time), 0.0};
      told = watch.differ({0.0, 0.0, 1.0}, rate, PERIOD) || told;
    }
    check::that(told, "they differ");
    watch.restart();
    const double rests[3] = {};
    for (int tick = 0; tick < 3; ++tick)
      check::that(!watch.differ({0.0, 0.0, 1.0}, rests, PERIOD), "begun anew, nothing is known");
  }
}

void run() {
  what_differed_before_a_pause_is_forgotten();
  gains_differ_beyond_a_half();
  larger_differences_are_told_sooner();
  small_differences_are_none();
  turns_are_seen_beside_the_noise();
  one_reading_echoes_no_longer_than_the_fastest_turn();
  a_fault_moves_the_zero_by_little();
  a_usual_load_is_followed();
}

const check::Listed listed(run);

}  // namespace turn_watch_test
