// The estimator on rubber with hysteresis whose element it was told: between samples, from the first landing on, and of
// feet that always stand.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "check.hpp"
#include "plantar/foot_estimator.hpp"

namespace estimator_element_test {

using namespace plantar;

constexpr double STIFFNESS = 900.0, DAMPING = 20.0, SLIP_ANGLE = 0.01, SLIP_TORQUE = 8.0, WEIGHT = 1500.0;
constexpr Frame HERE = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
constexpr int FINE = 20;  // steps of the rubber in one sample

// One foot beside another one that carries the rest; the IMU sits on the ankle.
EstimatorModel model(bool always, double told_std, int axis) {
  EstimatorModel model;
  model.weight = WEIGHT, model.joints = {"free"};
  for (const char* name : {"left", "right"}) {
    FootModel foot;
    foot.name = name, foot.always = always;
    foot.bush = foot.sole = foot.sensor = HERE;
    foot.polygon = {{0.1, 0.06}, {-0.1, 0.06}, {-0.1, -0.06}, {0.1, -0.06}};
    foot.place_std = {0.003, 0.003};
    foot.slip_angle[axis] = SLIP_ANGLE, foot.slip_torque[axis] = SLIP_TORQUE, foot.slip_torque_std[axis] = told_std;
    foot.linear[1 - axis] = true;
    model.feet.push_back(foot);
  }
  return model;
}

// `angle(t)` and `load(t)` of the left foot, sampled at `rate_hz` for `seconds`; what is known of it at the end.
// missing: from when to when its force sensor says nothing.
template <class Angle, class Load>
FootEstimate after(double seconds, double rate_hz, bool always, double first_state, Angle angle, Load load,
                   double told_std = 1e-6, double torque_noise = 0.0, std::array<double, 2> missing = {},
                   double attitude_noise = 0.0, int axis = 0) {
  FootEstimator estimator(model(always, told_std, axis));
  std::mt19937 random(0);
  std::normal_distribution<double> normal;
  FootEstimate last;
  double state = first_state, position = 0.0;
  for (int i = 0; i < static_cast<int>(seconds * rate_hz); ++i) {
    const double t = i / rate_hz, step = 1.0 / (FINE * rate_hz);
    for (int k = 0; i > 0 && k < FINE; ++k) {
      const double now = t - (FINE - 1 - k) * step;
      state = std::clamp(state + (angle(now) - angle(now - step)) / SLIP_ANGLE, -1.0, 1.0);
    }
    const double p = angle(t), rate = (angle(t + 1e-6) - angle(t - 1e-6)) / 2e-6, noise = 1e-9 * std::sin(1e5 * t);
    const double carried = load(t), stands = carried > 0.1 * WEIGHT ? 1.0 : 0.0;
    const double torque =
        stands * (STIFFNESS * p + DAMPING * rate + SLIP_TORQUE * state) + torque_noise * normal(random);
    const double seen = p + attitude_noise * normal(random);
    double attitude[4] = {std::cos(seen / 2), noise, -std::sin(seen / 2), noise}, gyroscope[3] = {noise, -rate, noise};
    if (axis == 1) std::swap(attitude[1], attitude[2]), std::swap(gyroscope[0], gyroscope[1]);
    std::array<double, 6> wrench[2] = {{0.0, noise, carried + noise, noise, torque + noise, 0.0},
                                             {0.0, noise, WEIGHT - carried + noise, noise, noise, 0.0}};
    if (axis == 1) std::swap(wrench[0][3], wrench[0][4]);
    if (t >= missing[0] && t < missing[1]) wrench[0].fill(std::nan(""));
    last = estimator.step({t, {&position, 1}, {}, attitude, gyroscope, {}, wrench})[0];
  }
  return last;
}

double quick(double t) { return 0.02 * std::sin(8.0 * t) + 0.01 * std::sin(21.0 * t); }
double all(double) { return 0.5 * WEIGHT; }

// At 100 Hz an angle goes 0.1 mrad beyond its samples, and the element with it.
void follows_what_turns_between_samples() {
  const FootEstimate found = after(60.0, 100.0, false, 0.0, quick, all);
  check::near(found.pitch.stiffness.value, STIFFNESS, 2e-4 * STIFFNESS, "stiffness beside an element, 100 Hz");
  check::near(found.pitch.damping.value, DAMPING, 5e-4 * DAMPING, "damping beside an element, 100 Hz");
}

// Where a robot rolls alone, it is one that pitches, turned by a quarter.
void roll_is_as_pitch() {
  const FootEstimate pitch = after(20.0, 100.0, false, 0.0, quick, all);
  const FootEstimate roll = after(20.0, 100.0, false, 0.0, quick, all, 1e-6, 0.0, {}, 0.0, 1);
  const auto same = [&](Parameter AxisEstimate::*one, const char* what) {
    const Parameter &rolls = roll.roll.*one, &pitches = pitch.pitch.*one;
    check::near(rolls.value, pitches.value, 1e-5 * pitches.value, what);
    check::near(rolls.std, pitches.std, 1e-2 * pitches.std, what);
  };
  same(&AxisEstimate::stiffness, "stiffness beside an element in roll");
  same(&AxisEstimate::damping, "its damping");
  same(&AxisEstimate::slip_torque, "its slip torque");
  check::that(roll.roll.identified && pitch.pitch.identified, "both identified");
}

// A foot that stands throughout began somewhere on its way, too.
void knows_nothing_of_a_foot_that_always_stands() {
  const auto slow = [](double t) { return 0.004 * std::sin(2.0 * t) + 0.0006 * t; };
  const FootEstimate found = after(20.0, 200.0, true, 1.0, slow, all);
  check::near(found.pitch.stiffness.value, STIFFNESS, 5e-3 * STIFFNESS, "stiffness of a foot that always stands");
}

// A quick turn shows within few ticks where the element is. What the filter still holds of it is of another state.
void takes_nothing_from_before_it_knew() {
  const auto turns = [](double t) { return 0.02 * std::sin(8.0 * t + 0.3) + 0.004 * std::sin(3.7 * t); };
  const FootEstimate found = after(3.0, 100.0, true, -1.0, turns, all);
  check::near(found.pitch.damping.value, DAMPING, 5e-3 * DAMPING, "damping behind a quick turn");
}

// Within its slip angle the element is a spring beside the spring, and only what was told of it tells both apart.
void says_what_rests_on_what_it_was_told() {
  constexpr double NOISE = 0.1;
  const auto swings = [](double size) { return [size](double t) { return size * std::sin(2.0 * t); }; };
  const FootEstimate small = after(60.0, 200.0, false, 0.0, swings(0.006), all, 0.02 * SLIP_TORQUE, NOISE);
  check::that((small.flags & (PITCH_UNTESTED | PITCH_UNKNOWN)) == PITCH_UNTESTED, "small motions test no slip torque");
  check::that(!small.pitch.identified && small.pitch.stiffness.half_width > 0.03 * STIFFNESS, "and tell no stiffness");
  const FootEstimate large = after(60.0, 200.0, false, 0.0, swings(0.02), all, 0.02 * SLIP_TORQUE, NOISE);
  check::that((large.flags & (PITCH_UNTESTED | PITCH_UNKNOWN)) == 0 && large.pitch.identified, "large ones do");
  check::near(large.pitch.stiffness.value, STIFFNESS, 0.01 * STIFFNESS, "and tell the stiffness");
  // A torque that may be off by dT lets the stiffness be off by dT / SLIP_ANGLE: a hundredth of it is little.
  for (const double told : {0.85, 1.15}) {
    const double deviation = told * 0.01 * STIFFNESS * SLIP_ANGLE / 1.96;
    const FootEstimate known = after(60.0, 200.0, false, 0.0, swings(0.006), all, deviation, NOISE);
    const bool well = told < 1.0;
    check::that(!(known.flags & PITCH_UNTESTED) == well, "what is well known needs no test");
    check::that(known.pitch.identified == well, "and is identified");
  }
}

// Each landing swings the element from one end to the other while the sole lies flat; the stance itself moves little.
void is_known_from_the_first_landing_on() {
  constexpr double STEP = 1.3, AIR = 0.4, LANDS = 0.25, TURN = 2.0 * std::numbers::pi;
  const auto since = [](double t) { return std::fmod(t, STEP) - AIR; };
  const auto swings = [since](double t) {
    const double s = since(t);
    if (s < 0.0) return 0.0;
    if (s < LANDS) return 0.03 * std::sin(TURN * s / LANDS) * std::sin(0.5 * TURN * s / LANDS);
    return 0.006 * std::pow(std::sin(TURN * (s - LANDS) / (STEP - AIR - LANDS)), 3);
  };
  const auto load = [since](double t) { return since(t) < 0.0 ? 0.0 : 0.8 * WEIGHT; };
  const FootEstimate found = after(6.0 * STEP, 1000.0, false, 0.0, swings, load);
  check::near(found.pitch.stiffness.value, STIFFNESS, 1e-4 * STIFFNESS, "stiffness from the first steps");
  check::near(found.pitch.damping.value, DAMPING, 1e-3 * DAMPING, "damping from the first steps");
}

// Behind some seconds of standing, steps whose stances never swing an element from end to end: what it does behind a
// landing hangs on how the foot lifted. In the air spring and element balance each other, and the element sticks on its
// way there.
struct Steps {
  static constexpr double STANDS = 12.0, STANCE = 1.0, STEP = 1.4;  // s
  static constexpr int NUMBER = 30, PIECES = 4000;
  double air[NUMBER + 1] = {};  // the bush's angle before each stance [rad]

  Steps() {
    double state = 0.0;
    const auto stood = [this](int i) { return (*this)(STANDS * i / (10.0 * PIECES)); };
    for (int i = 1; i < 10 * PIECES; ++i)
      state = std::clamp(state + (stood(i) - stood(i - 1)) / SLIP_ANGLE, -1.0, 1.0);
    for (int k = 0; k < NUMBER; ++k) {
      for (int i = 1; i <= PIECES; ++i)
        state = std::clamp(state + (stance(k, i / double(PIECES)) - stance(k, (i - 1) / double(PIECES))) / SLIP_ANGLE,
                           -1.0, 1.0);
      const double stiff = SLIP_TORQUE / SLIP_ANGLE, torque = STIFFNESS * lifts(k) + SLIP_TORQUE * state;
      air[k + 1] = lifts(k) - torque / (STIFFNESS + stiff);
      state += (air[k + 1] - lifts(k)) / SLIP_ANGLE;
    }
  }
  static double lifts(int k) { return k % 2 ? 0.013 : 0.022; }
  static double eased(double x) { return x * x * (3.0 - 2.0 * x); }
  double stance(int k, double share) const {
    const double sways = std::sin(std::numbers::pi * share);
    return air[k] + (lifts(k) - air[k]) * eased(share) + 0.005 * sways * sways * std::sin(11.0 * share);
  }
  double operator()(double t) const {
    if (t < STANDS) return 0.02 * std::sin(std::numbers::pi * t) + 0.01 * std::sin(3.0 * std::numbers::pi * t);
    const int k = static_cast<int>((t - STANDS) / STEP);
    const double since = t - STANDS - k * STEP;
    if (since < STANCE) return stance(k, since / STANCE);
    return lifts(k) + (air[k + 1] - lifts(k)) * eased(std::min((since - STANCE) / (0.5 * (STEP - STANCE)), 1.0));
  }
};

void is_followed_through_the_air() {
  const Steps steps;
  const auto load = [](double t) {
    const double since = t - Steps::STANDS;
    return since < 0.0 || std::fmod(since, Steps::STEP) < Steps::STANCE ? (0.7 + 0.1 * std::sin(7.0 * t)) * WEIGHT : 0.0;
  };
  const FootEstimate found = after(Steps::STANDS + 29.9 * Steps::STEP, 400.0, false, 0.0, steps, load);
  check::near(found.pitch.stiffness.value, STIFFNESS, 1e-3 * STIFFNESS, "stiffness of steps");
  // A state that is taken for another one is an offset: here none, as well as an attitude's lean lets anyone know.
  check::near(found.pitch.offset, 0.0, 0.4 * SLIP_TORQUE, "no offset of steps");
}

// The foot stands on while its sensor says nothing: its element is where nobody knows, not where a lift would leave it.
void a_pause_is_no_lift() {
  const auto swings = [](double t) { return t < 42.0 ? 0.02 * std::sin(2.0 * t) : 0.006 * std::sin(2.0 * t); };
  const FootEstimate found =
      after(52.0, 200.0, false, 0.0, swings, all, 0.02 * SLIP_TORQUE, 0.02, std::array<double, 2>{40.0, 42.0});
  check::that((found.flags & GROUND_CHANGED) == 0, "no other ground behind a pause");
  check::near(found.pitch.stiffness.value, STIFFNESS, 0.01 * STIFFNESS, "stiffness behind a pause");
}

// The gyroscope says how an element turns: an attitude's noise would drive it to and fro.
void is_not_moved_by_an_attitudes_noise() {
  const auto swings = [](double t) { return 0.02 * std::sin(2.0 * t); };
  const FootEstimate found = after(30.0, 200.0, false, 0.0, swings, all, 1e-6, 0.0, {}, 1e-3);
  check::near(found.pitch.stiffness.value, STIFFNESS, 0.01 * STIFFNESS, "stiffness under a noisy attitude");
}

void run() {
  a_pause_is_no_lift();
  is_not_moved_by_an_attitudes_noise();
  is_followed_through_the_air();
  follows_what_turns_between_samples();
  roll_is_as_pitch();
  knows_nothing_of_a_foot_that_always_stands();
  takes_nothing_from_before_it_knew();
  is_known_from_the_first_landing_on();
  says_what_rests_on_what_it_was_told();
}

const check::Listed listed(run);

}  // namespace estimator_element_test
