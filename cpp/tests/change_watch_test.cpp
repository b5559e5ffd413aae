// What is other ground, what is a stumble, and what no ground does.
#include "online/change_watch.hpp"

#include <cmath>

#include "check.hpp"

namespace change_watch_test {

using namespace plantar;
using Verdict = ChangeWatch::Verdict;

constexpr double ROW = 0.025;  // s
constexpr double STIFFNESS = 800.0, DAMPING = 50.0;

// One probe of `rows` in which the foot is bent to 10 mrad, and finds `change` of what was learnt, beside noise [N·m].
Verdict probed(ChangeWatch& watch, double change, double noise, int rows = PROBE_ROWS) {
  for (int i = 0; i < rows; ++i) {
    const double angle = 0.01 * i / rows;
    watch.add(1.0, 0.0, 0.0, angle, 0.0, STIFFNESS * change * angle, ROW);
  }
  return watch.judge(STIFFNESS, 1.0, noise);
}

// What an element's state splits to a quarter of a second speaks of other ground, if it is clear.
void a_short_probe_speaks() {
  ChangeWatch watch;
  check::that(probed(watch, -0.5, 0.02) == Verdict::usual, "one probe alone may be a stumble");
  check::that(watch.softer() > 5.0 && watch.stiffer() == 0.0, "a short probe of half the stiffness");
  watch.forget();
  check::that(watch.calm(), "what was said is forgotten");
}

// A probe that shows little may find any stiffness, but not one so far below zero: a sensor's sign, not a ground's.
void a_probe_that_shows_little_may_be_sure() {
  ChangeWatch watch;
  check::that(probed(watch, -1.3, 2.0) == Verdict::usual, "below zero by less than noise makes");
  check::that(probed(watch, -3.3, 2.0) == Verdict::impossible, "far below zero");
}

// Eight rows up to 10 mrad show a stiffness to noise over 6.5 N·m.
void a_probe_that_shows_too_little_says_nothing() {
  for (const double share : {0.13, 0.17}) {
    ChangeWatch watch;
    probed(watch, -0.4, share * STIFFNESS * 0.01 / 8 * std::sqrt(42.0));
    check::that((watch.softer() > 0.0) == (share < 0.15), "a deviation of 15 % of the stiffness");
  }
}

// Of normal deviations: how probes scatter before any was seen, the probe's own, and that of what was learnt.
void what_a_probe_says_is_a_likelihood() {
  constexpr double AWAY = -0.3, OWN = 0.06, KNOWN = 0.08, CHANGED = -0.4;
  const auto bent = [](ChangeWatch& watch, double away, double own) {
    for (int i = 0; i < 8; ++i) watch.add(1.0, 0.0, 0.0, 0.00125 * i, 0.0, STIFFNESS * away * 0.00125 * i, ROW);
    watch.judge(STIFFNESS, KNOWN * STIFFNESS, own * STIFFNESS * 0.00125 * std::sqrt(42.0));
  };
  ChangeWatch watch, sure;
  bent(watch, AWAY, OWN);
  const double variance = 0.1 * 0.1 + OWN * OWN + KNOWN * KNOWN;
  check::near(watch.softer(), CHANGED * (AWAY - 0.5 * CHANGED) / variance, 1e-3, "for a ground that is softer");
  check::that(watch.stiffer() == 0.0, "not stiffer");
  bent(watch, -AWAY, OWN);
  check::that(watch.softer() == 0.0 && watch.stiffer() > 0.0, "a contrary one speaks against it");
  bent(sure, -0.9, 0.01);
  check::near(sure.softer(), 7.5, 1e-9, "a single probe says no more");
}

// After unclear probes, and after the first one of the change itself.
void two_clear_probes_are_enough() {
  ChangeWatch watch;
  for (int i = 0; i < 60; ++i) probed(watch, i % 2 ? 0.12 : -0.12, 0.8);
  check::that(watch.calm(), "unclear probes say nothing");
  check::that(probed(watch, -0.69, 0.2) == Verdict::usual && probed(watch, -0.37, 0.2) == Verdict::changed,
              "two clear ones do");
}

// Steps that differ are usual, once contrary ones have followed.
void steps_that_differ_become_usual() {
  ChangeWatch watch;
  for (int i = 0; i < 60; ++i)
    check::that(probed(watch, i % 2 ? 0.25 : -0.25, 0.05) == Verdict::usual, "steps that differ");
  probed(watch, -0.37, 0.05);
  check::that(watch.softer() < 7.0, "so that one more says less");
}

// Parts of a step: a motion at 1 Hz with one at 3 Hz on it. Told is a change of the bush's torque where it is late [s],
// or where the ground has other shares of its spring and its damper.
bool change_told(double late, double spring, double damper) {
  ChangeWatch watch;
  bool told = false;
  for (int probe = 0; probe < 20; ++probe) {
    for (int i = 0; i < 12; ++i) {
      double angle = 0.0, rate = 0.0, torque_rate = 0.0, left = 0.0;
      for (const double frequency : {1.0, 3.0}) {
        const double omega = 2.0 * std::acos(-1.0) * frequency, size = 0.01 / frequency;
        const auto bush = [&](double at, double k, double c) {
          return size * (k * std::sin(at) + c * omega * std::cos(at));
        };
        const double phase = omega * ROW * i + 0.6 + probe, k = spring * STIFFNESS, c = damper * DAMPING;
        angle += size * std::sin(phase), rate += size * omega * std::cos(phase);
        torque_rate += omega * bush(phase - omega * late + std::acos(0.0), k, c);
        left += bush(phase - omega * late, k, c) - bush(phase, STIFFNESS, DAMPING);
      }
      watch.add(1.0, rate, -torque_rate, angle, 0.0, left, ROW);
    }
    told = told || watch.judge(STIFFNESS, 1.0, 0.1) == Verdict::changed;
  }
  return told;
}

void a_late_torque_is_no_other_ground() {
  for (const double late : {-0.03, 0.015, 0.03}) check::that(!change_told(late, 1.0, 1.0), "only late");
  check::that(change_told(0.0, 0.5, 0.5), "half the bush");
  check::that(change_told(0.0, 2.0, 1.0) && change_told(0.0, 0.5, 1.0), "another spring alone");
  check::that(change_told(0.03, 0.5, 0.5), "half the bush, and late");
  check::that(!change_told(0.03, 0.7, 0.7), "softer ground by a delay only");
}

void no_ground_pulls_the_other_way() {
  ChangeWatch watch;
  check::that(probed(watch, -2.0, 0.02) == Verdict::impossible && watch.doubted(), "a spring that pushes on");
  check::that(watch.softer() == 0.0, "which is no softer ground");
  check::that(probed(watch, -0.9, 0.02) == Verdict::usual && !watch.doubted(), "one of a tenth is soft");
}

void what_no_line_explains_is_no_ground() {
  ChangeWatch watch;
  for (int i = 0; i < 30; ++i) watch.add(1.0, 0.0, 0.0, 0.01 * i / 30, 0.0, i % 2 ? 3.0 : -3.0, ROW);
  check::that(watch.judge(STIFFNESS, 1.0, 0.02) == Verdict::impossible, "a torque of its own");
  check::that(!watch.full(), "no probe");
  probed(watch, 0.0, 10.0, 12);
  for (int i = 0; i < 12; ++i) watch.add(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, ROW);
  check::that(watch.full(), "probes are short until one is clear");
}

// Two contrary probes become usual, each by half of what both were off: then nothing is suspected any more.
void the_usual_scatter_follows_what_was_off() {
  const auto bent = [](ChangeWatch& watch, double away) {
    for (int i = 0; i < 8; ++i) watch.add(1.0, 0.0, 0.0, 0.00125 * i, 0.0, STIFFNESS * away * 0.00125 * i, ROW);
    watch.judge(STIFFNESS, 0.0, 1e-6);
  };
  ChangeWatch watch;
  bent(watch, -0.22), bent(watch, 0.18);
  check::that(watch.calm(), "contrary ones");
  double scatter = 0.01;
  for (int probe = 0; probe < 2; ++probe) scatter += 0.05 * (0.5 * (0.22 * 0.22 + 0.18 * 0.18) - scatter);
  bent(watch, -0.25);
  check::near(watch.softer(), -0.4 * (-0.25 + 0.2) / scatter, 1e-3, "one more says less");
}

// Seven rows say nothing, however clear they are, and a probe that has begun is not calm.
void a_probe_needs_rows() {
  ChangeWatch watch;
  probed(watch, -0.5, 0.02, PROBE_ROWS - 1);
  check::that(watch.calm(), "seven rows");
  watch.add(1.0, 0.0, 0.0, 0.01, 0.0, -4.0, ROW);
  check::that(!watch.calm(), "a probe has begun");
  watch.forget();
  check::that(watch.calm() && !watch.full(), "its rows are forgotten, too");
  probed(watch, 0.0, 0.02);
  check::that(watch.calm(), "they do not speak in the next one");
}

// What speaks against a change is no more of one probe than what speaks for it.
void one_contrary_probe_is_one_stumble() {
  ChangeWatch watch;
  probed(watch, -0.9, 0.02), probed(watch, -0.5, 0.02, 2 * PROBE_ROWS);
  const double before = watch.softer();
  ChangeWatch other = watch;
  probed(other, 0.9, 0.02);
  check::that(before > MOST_OF_ONE, "two for it");
  check::near(other.softer(), before - MOST_OF_ONE, 1e-9, "one against it");
}

// Whatever a delay leaves open is open: a motion of one pace does not tell it from a stiffness.
void a_probe_that_a_late_torque_explains_says_nothing() {
  for (const double late : {0.0, -10.0}) {  // 1/s: of a torque that grows with the angle
    ChangeWatch watch;
    for (int i = 0; i < PROBE_ROWS; ++i) {
      const double angle = 0.01 * i / PROBE_ROWS;
      watch.add(1.0, 0.0, late * STIFFNESS * angle, angle, 0.0, -0.4 * STIFFNESS * angle, ROW);
    }
    watch.judge(STIFFNESS, 1.0, 0.02);
    check::that((watch.softer() == 0.0) == (late != 0.0), "which of both it is");
  }
}

// Each ends with what was suspected: it says nothing of the next ones, forgotten or taken as usual.
void what_was_suspected_counts_once() {
  ChangeWatch watch, fresh;
  probed(watch, -0.5, 0.02);
  watch.forget();
  for (ChangeWatch* one : {&watch, &fresh})
    for (int i = 0; i < 40; ++i) probed(*one, i % 2 ? 0.15 : -0.15, 0.02);
  probed(watch, -0.37, 0.02), probed(fresh, -0.37, 0.02);
  check::near(watch.softer(), fresh.softer(), 1e-9, "as if it had never been");
}

void run() {
  the_usual_scatter_follows_what_was_off();
  a_probe_needs_rows();
  one_contrary_probe_is_one_stumble();
  a_probe_that_a_late_torque_explains_says_nothing();
  what_was_suspected_counts_once();
  what_a_probe_says_is_a_likelihood();
  a_probe_that_shows_too_little_says_nothing();
  a_short_probe_speaks();
  a_probe_that_shows_little_may_be_sure();
  two_clear_probes_are_enough();
  steps_that_differ_become_usual();
  a_late_torque_is_no_other_ground();
  no_ground_pulls_the_other_way();
  what_no_line_explains_is_no_ground();
}

const check::Listed listed(run);

}  // namespace change_watch_test
