// Slides of two soles against each other: how quick, how far and how surely, in whose frame.
#include "online/slip_gate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check.hpp"

namespace slip_gate_test {

using namespace plantar;

constexpr double PERIOD = 0.001;  // s

// Of a right sole beside a left one; whether a slide was sure behind the filter's start.
template <typename Heading>
bool slides(double left, const Heading& right) {
  SlipGate gate;
  bool sure = false;
  for (int tick = 0; tick < 3000; ++tick) {
    const double time = PERIOD * tick, turned = right(time);
    const double heading = std::remainder(turned, 2.0 * std::numbers::pi);
    sure = gate.step({0.0, 0.1, left}, {0.0, -0.1, heading}, PERIOD) == SlipGate::Verdict::sure || sure;
  }
  return sure;
}

void a_heading_that_passes_half_a_turn_is_no_slide() {
  for (const double back : {3.1416, -3.1416}) {
    const auto sways = [back](double time) { return back + 0.005 * std::sin(2.0 * time); };
    const auto turns = [back](double time) { return back + 0.1 * std::clamp(time - 1.0, 0.0, 1.0); };
    check::that(!slides(back, sways), "a robot that faces back");
    check::that(slides(back, turns), "one sole that turns");
  }
}

// Slower than any slide, for longer than a slide takes.
void a_creep_is_no_slide() {
  SlipGate gate;
  bool told = false;
  for (int tick = 0; tick < 6000; ++tick) {
    const double time = PERIOD * tick, crept = 0.0019 * std::clamp(time - 4.0, 0.0, 0.8);
    const auto verdict = gate.step({0.0, 0.1, 0.0}, {crept, -0.1, 0.0}, PERIOD);
    told = told || (time > 1.0 && verdict != SlipGate::Verdict::none);
  }
  check::that(!told, "a creep of two millimetres a second");
}

// Soles that wander about each other at an even speed, which is noise; how sure a gate is of what comes.
struct Wandering {
  static constexpr double USUAL = 0.004, WAY = 3.0;  // m/s, rad/s

  SlipGate gate;
  double x = 0.0, y = 0.0, turn = 0.0;

  // The surest verdict in some seconds at a speed, that of noise where none is told.
  SlipGate::Verdict go(double seconds, double speed = USUAL) {
    SlipGate::Verdict surest = SlipGate::Verdict::none;
    for (int tick = 0; tick < seconds / PERIOD; ++tick) {
      turn += WAY * PERIOD, x += speed * std::cos(turn) * PERIOD, y += speed * std::sin(turn) * PERIOD;
      surest = std::max(surest, gate.step({0.0, 0.1, 0.0}, {x, y - 0.1, 0.0}, PERIOD));
    }
    return surest;
  }
};

// Noise's deviation of an even speed is that over 1.794: 3.5 of them are 1.95 times as quick, five 2.79 times.
void a_slide_has_to_be_surely_more_than_noise_once() {
  constexpr double QUICK = 2.4 * Wandering::USUAL, SURELY = 3.2 * Wandering::USUAL;
  const auto wandering = [] {
    Wandering soles;
    soles.go(10.0);
    check::that(soles.go(1.0) == SlipGate::Verdict::none, "noise");
    return soles;
  };
  Wandering slow = wandering(), once = wandering(), paused = wandering(), anew = wandering();
  check::that(slow.go(0.3, 1.7 * Wandering::USUAL) == SlipGate::Verdict::none, "less than 3.5 deviations");
  check::that(slow.go(0.3, QUICK) == SlipGate::Verdict::possible, "less than five");
  once.go(0.08, SURELY);
  check::that(once.go(0.15, QUICK) == SlipGate::Verdict::sure, "a slide goes on though it is slower");
  check::that(paused.go(0.3, SURELY) == SlipGate::Verdict::sure, "more than five");
  paused.go(0.3);
  check::that(paused.go(0.3, QUICK) == SlipGate::Verdict::possible, "behind a pause it is another");
  anew.go(0.3, SURELY);
  anew.gate.restart();
  anew.go(0.101);
  check::that(anew.go(0.02) == SlipGate::Verdict::none, "begun anew, no way was covered");
  check::that(anew.go(0.3, QUICK) == SlipGate::Verdict::possible, "and nothing is sure");
}

// Quick enough by far, but no way: a sole that is jolted to and fro.
void a_slide_covers_a_way() {
  const auto slid = [](double way) {
    SlipGate gate;
    bool sure = false;
    for (int tick = 0; tick < 4000; ++tick) {
      const double time = PERIOD * tick, x = std::clamp(0.05 * (time - 2.0), 0.0, way);
      sure = gate.step({0.0, 0.1, 0.0}, {x, -0.1, 0.0}, PERIOD) == SlipGate::Verdict::sure || sure;
    }
    return sure;
  };
  check::that(!slid(0.0008), "less than 0.9 mm");
  check::that(slid(0.0015), "more");
}

// Pushed on by a third of a millimetre at a time: closer than a pause, the pushes are one slide.
void slides_that_are_close_are_one() {
  const auto pushed = [](double every) {
    SlipGate gate;
    bool sure = false;
    for (int tick = 0; tick < 4000; ++tick) {
      const double since = std::max(PERIOD * tick - 2.0, 0.0), x = 0.00035 * std::min(std::floor(since / every), 5.0);
      sure = gate.step({0.0, 0.1, 0.0}, {x, -0.1, 0.0}, PERIOD) == SlipGate::Verdict::sure || sure;
    }
    return sure;
  };
  check::that(pushed(0.12), "closer than a pause");
  check::that(!pushed(0.3), "farther apart each is too short");
}

// Of two soles the place of one in the other's frame, and a turn as its way at half a sole.
void soles_slide_by_what_they_move_in_each_other() {
  const auto slides = [](double together, double apart) {
    SlipGate gate;
    bool sure = false;
    for (int tick = 0; tick < 4000; ++tick) {
      const double time = std::max(PERIOD * tick - 1.0, 0.0), all = together * time;
      const double own = apart * std::min(time, 2.0);
      sure = gate.step({-0.1 * std::sin(all), 0.1 * std::cos(all), all},
                       {0.1 * std::sin(all), -0.1 * std::cos(all), all + own}, PERIOD) == SlipGate::Verdict::sure || sure;
    }
    return sure;
  };
  check::that(!slides(0.5, 0.0), "a robot that turns with its ground");
  check::that(!slides(0.5, 0.9 * LEAST_SPEED / 0.1), "a sole that turns by less than the least speed at 0.1 m");
  check::that(slides(0.5, 1.2 * LEAST_SPEED / 0.1), "and by more");
}

void run() {
  a_heading_that_passes_half_a_turn_is_no_slide();
  a_creep_is_no_slide();
  a_slide_has_to_be_surely_more_than_noise_once();
  a_slide_covers_a_way();
  slides_that_are_close_are_one();
  soles_slide_by_what_they_move_in_each_other();
}

const check::Listed listed(run);

}  // namespace slip_gate_test
