// What keeps readings from being believed, each watch by itself: zeros from the air, edges, delays, loads and noise.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "check.hpp"
#include "online/air_zero.hpp"
#include "online/contradiction.hpp"
#include "online/delay_watch.hpp"
#include "online/edge_watch.hpp"
#include "online/foot_noise.hpp"
#include "online/shaking.hpp"

namespace gates_test {

using namespace plantar;

constexpr double WEIGHT = 500.0, PERIOD = 0.001;  // N, s

void a_zero_is_the_mean_of_swings_without_their_ends() {
  AirZero zero;
  const auto swing = [&zero](double force) {
    for (int tick = 0; tick < 1000; ++tick) {
      const bool ends = tick < 40 || tick >= 960;  // they still touch the ground, by less than what is calm
      const double read = ends ? force + 20.0 : force;
      zero.swing({0.0, 0.0, read, 0.0, 0.5, 0.0}, read, WEIGHT, PERIOD);
    }
    zero.landed();
  };
  check::that(!zero.known(), "nothing is known before the first swing");
  swing(7.0);
  check::that(zero.known(), "known behind it");
  check::near(zero.value()[2], 7.0, 1e-9, "the force of its middle");
  check::near(zero.value()[4], 0.5, 1e-9, "and the torque");
  swing(9.0);
  check::near(zero.value()[2], 8.0, 1e-9, "two swings count alike");
}

// A foot that touches for ten milliseconds of each piece is not calm, though every piece ends as it began.
void a_swing_that_touches_is_none() {
  for (const double touch : {-26.0, -24.0, 24.0, 26.0}) {
    AirZero zero;
    for (int tick = 0; tick < 1000; ++tick) {
      const double read = 7.0 + (tick % 50 >= 20 && tick % 50 < 30 ? touch : 0.0);
      zero.swing({0.0, 0.0, read, 0.0, 0.0, 0.0}, read, WEIGHT, PERIOD);
    }
    zero.landed();
    check::that(zero.known() == (std::abs(touch) < 25.0), "calm is what changes by less than a twentieth of the weight");
  }
}

// Three pieces of 50 ms, of which the first and the last do not count; every channel has a zero of its own.
void a_zero_needs_a_piece_between_both_ends() {
  const auto swung = [](double force, int ticks) {
    AirZero zero;
    for (int tick = 0; tick < ticks; ++tick) zero.swing({force, -force, 0.5 * force, 1.0, 2.0, 3.0}, 0.0, WEIGHT, PERIOD);
    zero.landed();
    return zero;
  };
  check::that(!swung(20.0, 110).known() && swung(20.0, 160).known(), "two pieces are ends alone");
  const double wanted[6] = {20.0, -20.0, 10.0, 1.0, 2.0, 3.0};
  for (int i = 0; i < 6; ++i) check::near(swung(20.0, 300).value()[i], wanted[i], 1e-12, "a channel");
  check::that(swung(64.0, 300).known() && !swung(69.0, 300).known(), "a force of 100 N in all is a fifth of the weight");
}

// A foot that touches in mid-swing may have been loaded before it, too.
void what_came_before_a_touch_is_no_zero() {
  AirZero zero;
  for (int tick = 0; tick < 900; ++tick) {
    const double read = tick < 400 ? 15.0 : tick < 450 ? 60.0 + 0.6 * tick : 7.0;
    zero.swing({0.0, 0.0, read, 0.0, 0.0, 0.0}, read, WEIGHT, PERIOD);
  }
  zero.landed();
  check::near(zero.value()[2], 7.0, 1e-9, "the mean behind it");
}

// The last eight swings count alike; the ninth as much as each of them.
void a_zero_drifts() {
  AirZero zero;
  const auto swing = [&zero](double force) {
    for (int tick = 0; tick < 300; ++tick) zero.swing({0.0, 0.0, force, 0.0, 0.0, 0.0}, force, WEIGHT, PERIOD);
    zero.landed();
  };
  for (int i = 0; i < 20; ++i) swing(0.0);
  swing(8.0);
  check::near(zero.value()[2], 1.0, 1e-9, "an eighth");
}

// At the band's edge each of two poles lets half of the power of what is quick through.
void a_foot_is_shaken_by_what_is_quicker_than_any_load() {
  const auto struck = [](double share, double frequency) {
    Shaking shaking(WEIGHT);
    bool told = false;
    for (int tick = 0; tick < 2500; ++tick) {
      const double since = PERIOD * tick - 2.0, turn = 2.0 * std::numbers::pi * frequency * since;
      const double force[3] = {0.0, 0.0, since > 0.0 ? share * WEIGHT * std::sqrt(2.0) * std::sin(turn) : 0.0};
      told = shaking.step(force, PERIOD) || told;
    }
    return told;
  };
  check::that(!struck(0.85 * 2.0 * SHAKING_SHARE, SHAKING_BAND), "at the band's edge, by less than two such shares");
  check::that(struck(1.2 * 2.0 * SHAKING_SHARE, SHAKING_BAND), "by more");
  check::that(!struck(10.0 * SHAKING_SHARE, 0.2 * SHAKING_BAND), "what is slow is a load");
}

void what_is_quicker_than_the_band_is_no_lean() {
  EdgeWatch watch(WEIGHT, 0.06);
  bool told = false;
  for (int tick = 0; tick < 400; ++tick) {
    const double noise = tick == 0 ? 0.0 : tick % 2 ? 0.01 : -0.01;
    told = watch.step(0.004, 300.0, {noise, 0.0}, {0.0, 0.0}, PERIOD) || told;
  }
  check::that(!told, "noise of an angle on an edge");
}

void an_edge_is_told_from_where_its_visit_began() {
  EdgeWatch watch(WEIGHT, 0.06);
  const auto leans = [&watch](double angle) {
    bool told = false;
    for (int tick = 0; tick < 200; ++tick) told = watch.step(0.004, 300.0, {angle, 0.0}, {0.0, 0.0}, PERIOD);
    return told;
  };
  check::that(!leans(0.05), "a foot that is bent as it comes to its edge does not lean");
  check::that(leans(0.06), "one that turns on while its torque stays does");
  watch.restart();
  check::that(!leans(0.06), "begun anew, it does not");
}

// A bush that is softer than it was thought bends on by half of what its torque explains.
void a_softer_bush_is_no_lean() {
  for (const double beyond : {0.0075, 0.0085}) {
    EdgeWatch watch(WEIGHT, 0.06);
    bool told = false;
    for (int tick = 0; tick < 400; ++tick) {
      const double bent = tick < 200 ? 0.0 : 0.01, angle = tick < 200 ? 0.0 : 0.01 + beyond;
      told = watch.step(0.004, 300.0, {angle, 0.0}, {bent, 0.0}, PERIOD);
    }
    check::that(told == (beyond > 0.008), "beyond three milliradians and half the bend");
  }
}

void readings_behind_a_pause_are_not_smoothed_with_those_before() {
  EdgeWatch watch(WEIGHT, 0.06);
  for (int tick = 0; tick < 200; ++tick) watch.step(0.004, 300.0, {0.0, 0.0}, {0.0, 0.0}, PERIOD);
  watch.restart();
  bool told = false;
  for (int tick = 0; tick < 200; ++tick) told = watch.step(0.004, 300.0, {0.03, 0.0}, {0.0, 0.0}, PERIOD) || told;
  check::that(!told, "another angle is where the visit begins");
}

void the_middle_of_a_small_sole_is_not_its_edge() {
  const auto leans = [](double half_width, double inside) {
    EdgeWatch watch(WEIGHT, half_width);
    bool told = false;
    for (int tick = 0; tick < 400; ++tick) {
      const double angle = tick < 200 ? 0.0 : 0.02;
      told = watch.step(inside, 0.5 * WEIGHT, {angle, 0.0}, {0.0, 0.0}, PERIOD);
    }
    return told;
  };
  check::that(leans(0.06, 0.015), "of a large one a zero may move the edge so far");
  check::that(!leans(0.021, 0.015), "of a small one it may not");
  check::that(leans(0.021, 0.009), "but nearer to it");
}

void a_delay_stays_in_doubt_until_it_is_excluded() {
  DelayWatch watch;
  const auto late = [&watch](double seconds, double half) {
    return watch.late(Lateness::of(seconds, half), 0.0, PERIOD);
  };
  check::that(!late(0.0045, 0.001), "less than five milliseconds");
  check::that(!late(0.012, 0.007), "or less than sure");
  check::that(late(0.012, 0.001), "more, and sure");
  check::that(late(0.0045, 0.001), "it may still be as late");
  check::that(late(0.0, 0.0), "nothing is seen: nothing is excluded");
  check::that(!late(0.0035, 0.001), "it cannot be");
}

// Whatever its sign; several feet's by their weights, and what was told by its own deviation.
void delays_add_by_their_weights() {
  const auto late = [](Lateness seen, double told) { return DelayWatch().late(seen, told, PERIOD); };
  Lateness both = Lateness::of(0.016, 0.002);
  both += Lateness::of(0.004, 0.004);
  check::near(both.sum / both.weight, (4.0 * 0.016 + 0.004) / 5.0, 1e-12, "the mean by squares of half widths");
  check::near(1.0 / both.weight, 4e-6 * 16e-6 / 20e-6, 1e-15, "and its half width's square");
  check::that(Lateness::of(0.01, 0.0).weight == 0.0 && !late(Lateness{}, 0.0), "nothing is seen");
  check::that(late(Lateness::of(-0.012, 0.001), 0.0), "earlier");
  check::that(late(Lateness::of(0.0105, 0.003), 0.002) && !late(Lateness::of(0.0095, 0.003), 0.002),
              "twice the half width of both");
  check::that(!DelayWatch().late(Lateness::of(0.012, 0.001), 0.0, 0.015), "less than a period of slow samples");
}

void an_unknown_zero_may_make_a_load_differ() {
  const auto differs = [](double share, int unknown) {
    WeightWatch watch(WEIGHT);
    bool told = false;
    for (int tick = 0; tick < 2000; ++tick) told = watch.differs(share * WEIGHT, unknown, PERIOD);
    return told;
  };
  check::that(differs(0.75, 0), "feet that carry three quarters of the robot");
  check::that(!differs(0.75, 1), "or of which one was not zeroed");
  check::that(differs(0.65, 1), "but by no more than that");
  check::that(!differs(0.65, 2), "two may be off by twice as much");
}

// A rate from angles has the angle's noise times the frequency, whose mean square below the cutoff is a third of the
// cutoff's.
void noise_of_a_rate_is_that_of_its_angle() {
  constexpr double CUTOFF = 5.0;
  FootNoise noise(CUTOFF);
  for (int tick = 0; tick < 5000; ++tick) {
    const double read = 1e-4 * std::sin(1e5 * tick);
    noise.follow({{read, read}, {0.0, 0.0}, {0.0, 0.0, 0.0}, false}, PERIOD, PERIOD);
  }
  const double edge = 2.0 * std::numbers::pi * CUTOFF;
  check::that(noise.of_angle[0] > 0.0, "there is noise");
  check::near(noise.of_rate[0] / noise.of_angle[0], edge * edge / 3.0, 1e-9, "a third of the cutoff's square");
  // What passes of white noise is the cutoff's share of all frequencies, of every signal.
  FootNoise all(CUTOFF), slow(CUTOFF);
  WhiteNoise alone;
  for (int tick = 0; tick < 5000; ++tick) {
    const double read = std::sin(1e5 * tick);
    alone.see(read, PERIOD);
    const FootNoise::Signals now = {{read, 2.0 * read}, {3.0 * read, 4.0 * read}, {5.0 * read, 6.0 * read, 7.0 * read}, true};
    all.follow(now, PERIOD, PERIOD), slow.follow(now, PERIOD, 0.021);
  }
  const double passes = 2.0 * CUTOFF * PERIOD * alone.variance();
  for (int a = 0; a < 2; ++a) {
    check::near(all.of_angle[a], std::pow(1.0 + a, 2) * passes, 1e-9 * passes, "of angles");
    check::near(all.of_rate[a], std::pow(3.0 + a, 2) * passes, 1e-9 * passes, "of rates");
    check::that(slow.of_angle[a] == 0.0 && slow.of_rate[a] == 0.0, "samples that are too slow show none");
  }
  for (int i = 0; i < 3; ++i) check::near(all.of_force[i], std::pow(5.0 + i, 2) * passes, 1e-9 * passes, "of forces");
}

void run() {
  what_came_before_a_touch_is_no_zero();
  a_softer_bush_is_no_lean();
  readings_behind_a_pause_are_not_smoothed_with_those_before();
  a_zero_is_the_mean_of_swings_without_their_ends();
  a_swing_that_touches_is_none();
  a_zero_needs_a_piece_between_both_ends();
  a_zero_drifts();
  a_foot_is_shaken_by_what_is_quicker_than_any_load();
  what_is_quicker_than_the_band_is_no_lean();
  an_edge_is_told_from_where_its_visit_began();
  the_middle_of_a_small_sole_is_not_its_edge();
  a_delay_stays_in_doubt_until_it_is_excluded();
  delays_add_by_their_weights();
  an_unknown_zero_may_make_a_load_differ();
  noise_of_a_rate_is_that_of_its_angle();
}

const check::Listed listed(run);

}  // namespace gates_test
