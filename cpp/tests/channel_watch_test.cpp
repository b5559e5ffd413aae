// Readings that stand still while they should not: what repeats itself, what never moved, what is left behind by others.
#include "online/channel_watch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "check.hpp"

namespace channel_watch_test {

using namespace plantar;

constexpr double DT = 0.002;  // s

// A reading that is never the same twice.
double noise(int tick) { return 1e-4 * std::sin(1e5 * tick); }

void only_what_a_sensor_can_read_is_finite() {
  const double good[2] = {-1e11, 3.0}, large[2] = {0.0, -1e13}, none[2] = {std::nan(""), 0.0};
  const double endless[1] = {std::numeric_limits<double>::infinity()};
  check::that(all_finite(good), "numbers");
  check::that(!all_finite(large) && !all_finite(none) && !all_finite(endless), "and what are none");
}

void a_channel_is_stuck_after_a_time_and_some_samples() {
  const auto first_stuck = [](double dt) {
    RepeatWatch watch;
    int tick = 0;
    while (!watch.see(0.7, dt)) ++tick;
    return tick;
  };
  check::near(first_stuck(0.001), FROZEN_TIME / 0.001, 1.0, "quick samples repeat for a tenth of a second");
  check::near(first_stuck(0.05), FROZEN_SAMPLES, 0.0, "slow ones eight times");
  RepeatWatch watch;
  for (int i = 0; i < 200; ++i) watch.see(0.7, DT);
  check::that(watch.stuck() && !watch.changed(), "stuck");
  watch.see(0.8, DT);
  check::that(!watch.stuck() && watch.changed(), "and no longer");
}

// Known by the share of readings that repeat the last one, in ten seconds; what it did before it froze counts.
void a_channel_is_noisy_if_it_hardly_repeats_itself() {
  const auto noisy = [](double seconds, int every, bool freezes) {
    RepeatWatch watch;
    double value = 1.0;
    for (int i = 0; i < seconds / DT; ++i) watch.see(value = i % every == 0 ? value : 1.0 + noise(i), DT);
    for (int i = 0; freezes && i < 5000; ++i) watch.see(value, DT);
    return watch.noisy();
  };
  constexpr int NEVER = 1 << 20;
  check::that(!noisy(0.9 * NOISY_TIME, NEVER, false), "too short");
  check::that(noisy(1.2 * NOISY_TIME, NEVER, false), "long enough");
  check::that(noisy(1.2 * NOISY_TIME, NEVER, true), "what it repeats while it is frozen does not count");
  check::that(noisy(3.0 * NOISY_TIME, 150, false), "one in 150");
  check::that(!noisy(3.0 * NOISY_TIME, 70, false), "one in 70");
  const auto once_restless = [](double seconds) {
    RepeatWatch watch;
    for (int i = 0; i < seconds / DT; ++i) watch.see(1.0 + noise(i < 1.0 / DT ? i - i % 4 : i), DT);
    return watch.noisy();
  };
  check::that(!once_restless(1.1 * NOISY_TIME), "three in four of a second is a share of all that was seen");
  check::that(once_restless(5.0 * NOISY_TIME), "and forgotten by and by");
}

// A force sensor: all channels at once, or one alone that never did so, but for zeros.
void a_device_is_frozen_by_all_channels_or_by_a_noisy_one() {
  const auto frozen = [](double seconds, double held, bool all) {
    DeviceWatch<2> watch;
    for (int i = 0; i < seconds / DT; ++i) watch.frozen(std::array{1.0 + noise(i), 2.0 + noise(i)}, DT);
    bool told = false;
    for (int i = 0; i < 200; ++i) told = watch.frozen(std::array{held, all ? 2.0 : 2.0 + noise(i)}, DT);
    return told;
  };
  check::that(frozen(1.0, 1.0, true) && frozen(1.0, 0.0, true), "all of them");
  check::that(!frozen(1.0, 1.0, false), "one, of which little is known");
  check::that(frozen(15.0, 1.0, false), "one that was noisy");
  check::that(!frozen(15.0, 0.0, false), "but not at zero");
}

void a_joint_is_frozen_where_its_velocity_says_that_it_moves() {
  JointWatch watch;
  double frozen_after = 0.0;
  watch.frozen(0.3, -0.5, DT);
  for (int i = 1; i < 100 && frozen_after == 0.0; ++i)
    if (watch.frozen(0.3, i % 2 ? -0.5 : 0.5, DT)) frozen_after = i * DT;
  check::near(frozen_after, 0.02, 1.1 * DT, "a centimetre's or hundredth of a radian's way");
  check::that(!watch.frozen(0.3001, 0.5, DT), "until it moves by a bit");
  watch.frozen(0.3001, 4.0, DT);
  watch.restart();
  check::that(!watch.frozen(0.3001, 4.0, DT), "begun anew, no way was gone");
}

void a_joint_that_never_moved_is_dead_where_its_twin_did() {
  const auto dead = [](double own, double swing) {
    JointWatch joint, twin;
    for (int i = 0; i < 1000; ++i)
      joint.frozen(0.1 + own * (i > 500), 0.0, DT), twin.frozen(swing * std::sin(0.01 * i), 0.0, DT);
    return joint.dead(twin);
  };
  check::that(dead(0.0, 0.6 * TWIN_MOVED), "its twin has gone farther than noise");
  check::that(!dead(0.0, 0.4 * TWIN_MOVED), "or less");
  check::that(!dead(1e-6, 0.6 * TWIN_MOVED), "it has moved by a bit");
  JointWatch joint, twin, unread;
  for (int i = 0; i < 1000; ++i) joint.frozen(0.1, 0.0, DT), twin.frozen(0.1 * std::sin(0.01 * i), 0.0, DT);
  check::that(!joint.dead(unread), "nobody knows of a twin that was not read");
  check::that(joint.dead(twin), "of one that was");
  joint.restart(), twin.restart();
  joint.frozen(0.1, 0.0, DT);
  check::that(joint.dead(twin), "nobody has mended it between two recordings");
  joint.frozen(0.2, 0.0, DT);
  check::that(!joint.dead(unread), "it moves: it lives");
}

void a_way_is_counted_without_noise() {
  JointWatch joint, rests;
  for (int i = 0; i < 6000; ++i) {
    joint.frozen(0.1 * std::sin(std::numbers::pi * DT * i) + noise(i), 0.0, DT);
    rests.frozen(0.1 + 5.0 * noise(i), 0.0, DT);
  }
  check::near(joint.moved(), 6 * 4 * 0.1, 0.1, "six swings there and back");
  check::near(rests.moved(), 0.0, LEAST_WAY, "noise goes nowhere");
  const auto flickers = [](double step, int steps) {
    JointWatch flickering;
    for (int i = 0; i < 1000; ++i) flickering.frozen(0.1 + step * (i % 2 ? 1 + i % 4 / 3 * (steps - 1) : 0), 0.0, DT);
    return flickering.moved() > 0.1;
  };
  check::that(!flickers(1e-4, 18) && flickers(1e-4, 25), "two milliradians or millimetres, if its steps are fine");
  check::that(!flickers(1e-3, 3) && flickers(1e-3, 4), "three steps of a coarse encoder");
}

void a_joint_that_was_frozen_leaps() {
  const auto leapt = [](double stands, double by, double next) {
    JointWatch joint;
    double position = 0.0;
    for (int i = 0; i < 500; ++i) joint.frozen(position = 0.1 * DT * i, 0.1, DT);
    for (int i = 0; i < stands / DT; ++i) joint.frozen(position, 0.1, DT);
    joint.frozen(position + by, 0.1, DT);
    check::that(!joint.leapt(), "the next tick has to say so");
    joint.frozen(position + by + next, 0.1, DT);
    return joint.leapt();
  };
  check::that(leapt(0.3, 0.03, 0.006), "far at once, and hardly on");
  check::that(!leapt(0.3, 0.03, 0.009), "it sets out");
  check::that(!leapt(0.3, 0.5 * LEAST_WAY, 0.0), "not far");
  check::that(!leapt(0.01, 0.03, 0.1 * DT), "it had not stood");
}

// A joint that stands while its twin and its own leg go on; one that moves again had stood by itself, and so may do again.
struct Pair {
  JointWatch joint, twin;
  double leg = 0.0, swings = 0.0, stands_at = 0.0;
  int tick = 0;
  bool stuck = false;

  // Some seconds in which the twin goes `speed`, the leg as far and the joint stands, or goes as well.
  Pair& go(double seconds, double speed, bool stands, bool of_its_leg = true) {
    for (int i = 0; i < seconds / DT; ++i, ++tick) {
      swings += speed * DT, leg += of_its_leg ? speed * DT : 0.0;
      if (!stands) stands_at += std::max(speed, 0.001) * DT;
      joint.frozen(stands_at, 0.0, DT), twin.frozen(swings, 0.0, DT);
      stuck = joint.stuck(twin, leg);
    }
    return *this;
  }
};

void a_joint_is_stuck_where_others_go_farther_than_they_ever_did() {
  const auto standing = [](double way, bool of_its_leg = true) {
    Pair pair;
    return pair.go(1.0, 0.1, false).go(1.0, way, true, of_its_leg).stuck;
  };
  check::that(!standing(0.036), "as good ones do");
  check::that(standing(0.046), "farther");
  check::that(!standing(1.2 * LEFT_BEHIND, false), "its leg rests");
  Pair twin_rests;
  twin_rests.go(1.0, 0.1, false), twin_rests.leg += 1.2 * LEFT_BEHIND;
  check::that(!twin_rests.go(0.3, 0.0, true).stuck, "its twin rests");
  Pair slow;
  slow.go(1.0, 0.02, false).go(1.0, 0.8 * LEFT_BEHIND, true).go(0.1, 0.02, false).go(1.0, 1.4 * LEFT_BEHIND, true);
  check::that(!slow.stuck && !slow.joint.doubtful(), "it has stood for nearly so long, and moved again");
  slow.go(1.0, 0.4 * LEFT_BEHIND, true);
  check::that(slow.stuck, "but not for twice as long");
  Pair anew;
  anew.go(1.0, 0.02, false).go(1.0, 0.8 * LEFT_BEHIND, true), anew.joint.restart(), anew.twin.restart();
  anew.go(0.1, 0.02, false).go(1.0, 1.4 * LEFT_BEHIND, true);
  check::that(anew.stuck, "what stood before time began says nothing");
  Pair doubt;
  doubt.go(1.0, 0.02, false).go(1.0, 2.0 * LEAST_WAY, true);
  check::that(doubt.joint.doubtful() && !doubt.stuck, "less is a doubt");
  Pair short_rest;
  short_rest.go(1.0, 0.02, false).go(0.8 * FROZEN_TIME, 2.0 * LEAST_WAY / FROZEN_TIME, true);
  check::that(!short_rest.joint.doubtful(), "a step of its encoder takes so long");
}

// An encoder whose noise is gone while its twin's goes on.
void a_joint_is_stuck_where_its_noise_is_gone() {
  for (const bool once : {false, true}) {
    JointWatch joint, twin;
    bool stuck = false;
    for (int i = 0; i < 10000; ++i) {
      const bool both = once && i > 7000 && i < 7500, held = both || i > 9500;
      joint.frozen(0.1 + (held ? 0.0 : noise(i)), 0.0, DT), twin.frozen(0.2 + (both ? 0.0 : noise(i)), 0.0, DT);
      stuck = joint.stuck(twin, 0.0);
    }
    check::that(stuck != once, "unless both have stood without noise before");
  }
}

void run() {
  only_what_a_sensor_can_read_is_finite();
  a_channel_is_stuck_after_a_time_and_some_samples();
  a_channel_is_noisy_if_it_hardly_repeats_itself();
  a_device_is_frozen_by_all_channels_or_by_a_noisy_one();
  a_joint_is_frozen_where_its_velocity_says_that_it_moves();
  a_joint_that_never_moved_is_dead_where_its_twin_did();
  a_way_is_counted_without_noise();
  a_joint_that_was_frozen_leaps();
  a_joint_is_stuck_where_others_go_farther_than_they_ever_did();
  a_joint_is_stuck_where_its_noise_is_gone();
}

const check::Listed listed(run);

}  // namespace channel_watch_test
