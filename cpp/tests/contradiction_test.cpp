// A gyroscope that does not turn as the attitude does, and how soon that is over.
#include "online/contradiction.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "check.hpp"
#include "online/channel_watch.hpp"

namespace contradiction_test {

using namespace plantar;

constexpr double PERIOD = 0.005, BEGIN = 5.0, END = 9.0, LAST = 12.0;  // s: of the samples, of the fault
constexpr double SWAY = 0.05, PACE = 6.0;                              // rad, rad/s: of a chest that pitches

struct Told {
  bool before = false;  // the fault
  double during = 0.0;  // share of the fault's time
  double after = 0.0;   // s behind its end, for which the sensors still seem to differ
};

// The gyroscope reads `gain` times what turns, for four seconds.
Told with_gain(double gain) {
  TurnWatch watch;
  Told told;
  for (double time = 0.0; time < LAST; time += PERIOD) {
    const double angle = SWAY * std::sin(PACE * time), middle = time - 0.5 * PERIOD;
    const bool faulty = time >= BEGIN && time < END;
    const double mean = SWAY * PACE * std::cos(PACE * middle) * (faulty ? gain : 1.0);
    const double rate[3] = {0.0, mean, 0.0};
    const bool differ = watch.differ({-std::sin(angle), 0.0, std::cos(angle)}, rate, PERIOD);
    if (time < BEGIN) told.before = told.before || differ;
    if (faulty) told.during += differ * PERIOD / (END - BEGIN);
    if (time >= END && differ) told.after = time - END;
  }
  return told;
}

void a_fault_is_told_and_soon_over() {
  for (const double gain : {180.0 / std::acos(-1.0), -1.0, 0.0}) {
    const Told told = with_gain(gain);
    check::that(!told.before, "nothing is told of sensors that agree");
    check::that(told.during > 0.8, "a gyroscope that turns otherwise");
    check::that(told.after < 0.85, "itself again within a second");
  }
}

// A chest that turns by 3 mrad/s at most: at no moment does that say anything of the gyroscope, twenty seconds do. One
// with a zero of its own follows the turns all the same.
void small_turns_add_up() {
  for (const double gain : {0.0, -1.0, 1.0}) {
    TurnWatch watch;
    double told = 0.0;
    for (int i = 0; i < 8000; ++i) {
      const double time = PERIOD * i, angle = 5e-4 * std::sin(PACE * time), noise = 2e-5 * std::sin(1e5 * i);
      const double rate[3] = {0.01, gain * 5e-4 * PACE * std::cos(PACE * (time - 0.5 * PERIOD)), 0.0};
      const bool differ = watch.differ({-std::sin(angle) + noise, 0.0, std::cos(angle)}, rate, PERIOD);
      if (time > 20.0) told += differ / 4000.0;
    }
    check::that(gain == 1.0 ? told == 0.0 : told > 0.99, "a gyroscope that follows no turn, however small");
  }
}

// The attitude's noise has no part in what the gyroscope tells: beside turns as large as what it makes, that is no fault.
void noise_of_the_attitude_is_no_turn_of_its_own() {
  constexpr double NOISE = 1e-3, EDGE = 2.0 * std::numbers::pi * TURN_BAND;  // rad, rad/s
  const double left = 1.0 / (1.0 + PACE * PACE / (EDGE * EDGE));             // of the turns' power behind the band
  const double rate = EDGE * NOISE * std::sqrt(2.0 / left);
  TurnWatch watch;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, NOISE);
  bool told = false;
  for (int i = 0; i < 8000; ++i) {
    const double time = PERIOD * i, angle = rate / PACE * std::sin(PACE * time) + noise(random);
    const double turns[3] = {0.0, rate * std::cos(PACE * (time - 0.5 * PERIOD)), 0.0};
    told = watch.differ({-std::sin(angle), 0.0, std::cos(angle)}, turns, PERIOD) || told;
  }
  check::that(!told, "an attitude with noise beside a gyroscope that is right");
}

// A joint that has stood while its twin moved, and moved again, may stand as long again.
void what_has_stood_and_moved_again_is_not_doubted() {
  JointWatch one, twin;
  bool first = false, again = false, longer = false;
  for (int i = 0; i < 2400; ++i) {
    const double t = i / 200.0, stands = i == 0 ? 0.9e-4 : 1e-4 * std::floor(1.0 + std::min(t + 0.5, 8.0)), moves = 0.02 * t;
    one.frozen(stands, 0.0, 0.005), twin.frozen(moves, 0.02, 0.005);
    one.stuck(twin, twin.moved());
    first |= t < 1.0 && one.doubtful(), again |= t > 2.0 && t < 8.0 && one.doubtful(), longer |= t > 9.5 && one.doubtful();
  }
  check::that(first && !again && longer, "doubted at first and where it stands three times as long");
}

// What was frozen goes all at once where it should have gone meanwhile; a joint that sets out goes on.
void a_frozen_joint_leaps() {
  JointWatch frozen, starts, slows;
  int leaps = 0, false_ones = 0;
  for (int i = 0; i < 800; ++i) {
    const double t = i / 200.0, goes = 0.02 * t, quick = 0.5 * std::max(t - 2.0, 0.0);
    const double stops = 0.02 * std::min(t, 1.0) + 0.05 * (1.0 - std::exp(-50.0 * std::max(t - 2.0, 0.0)));
    frozen.frozen(t > 1.0 && t < 2.0 ? 0.02 : goes, 0.0, 0.005), starts.frozen(quick, 0.0, 0.005);
    slows.frozen(stops, 0.0, 0.005);
    leaps += frozen.leapt(), false_ones += starts.leapt() + slows.leapt();
  }
  check::that(leaps == 1 && false_ones == 0, "a frozen joint leaps, one that sets out does not");
}

void run() {
  a_frozen_joint_leaps();
  what_has_stood_and_moved_again_is_not_doubted();
  a_fault_is_told_and_soon_over();
  small_turns_add_up();
  noise_of_the_attitude_is_no_turn_of_its_own();
}

const check::Listed listed(run);

}  // namespace contradiction_test
