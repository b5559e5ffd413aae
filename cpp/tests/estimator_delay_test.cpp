// The estimator on wrenches that are late, and the deviations of values that move.
#include <algorithm>
#include <cmath>

#include "check.hpp"
#include "two_feet.hpp"

namespace estimator_delay_test {

using namespace plantar;

// Wrenches that are later than was told from the first tick on, or earlier, follow the deflection otherwise at each
// frequency.
void a_delay_that_was_told_wrongly_is_seen(double delay) {
  constexpr double TOLD = 0.01;
  FootEstimator estimator(two_feet(TOLD));
  FootEstimate last;
  bool believed = false;
  for (int i = 0; i < 12000; ++i) {
    const double t = i / 200.0;
    last = estimator.step(Sensors(t, delay).reading(t))[0];
    believed = believed || last.pitch.identified;
  }
  const bool wrong = delay != TOLD;
  check::that(((last.flags & LATE_WRENCH) != 0) == wrong, "a delay that is not the one that was told");
  check::that(believed != wrong, "and its numbers are not believed");
}

// One foot's force sensor alone may be late: the other foot's numbers stay believed. By less than is told, the damping's
// interval knows of it.
void one_foot_alone_may_be_late(double delay, bool seen) {
  FootEstimator estimator(two_feet());
  FootEstimate late, other;
  for (int i = 0; i < 12000; ++i) {
    const double t = i / 200.0;
    Sensors now(t);
    now.wrench[0] = Sensors(t, delay).wrench[0];
    const auto feet = estimator.step(now.reading(t));
    late = feet[0], other = feet[1];
  }
  check::that(((late.flags & LATE_WRENCH) != 0) == seen, "the foot that is late");
  check::that(!(other.flags & LATE_WRENCH) && other.pitch.identified, "not the other one");
  const auto off = [](const FootEstimate& foot) { return std::abs(foot.pitch.damping.value - TRUE_DAMPING[0]); };
  check::that(off(late) > 0.5 * TRUE_STIFFNESS[0] * delay && off(late) < late.pitch.damping.half_width,
              "its interval holds");
  check::that(other.pitch.damping.half_width < 0.5 * TRUE_STIFFNESS[0] * delay, "the other one's is no wider for it");
}

// A shaking that the bush does not follow is alike in all groups, whose scatter says little of it: by the rows' scatter
// a delay may be none, and it is neither told nor taken for sure.
void a_delay_within_the_rows_scatter_is_not_told() {
  constexpr double DELAY = 0.008, SHAKING = 0.25, SHAKES = 24.0;  // s, N·m, rad/s
  for (const double shaking : {0.0, SHAKING}) {
    FootEstimator estimator(two_feet());
    FootEstimate last;
    for (int i = 0; i < 12000; ++i) {
      const double t = i / 200.0;
      Sensors sensors(t, DELAY);
      for (auto& w : sensors.wrench) w[4] += shaking * std::sin(SHAKES * t);
      last = estimator.step(sensors.reading(t))[0];
    }
    const double by_delay = DELAY * TRUE_STIFFNESS[0];
    const bool sure = shaking == 0.0;
    check::that(((last.flags & LATE_WRENCH) != 0) == sure, "a delay beyond the rows' scatter");
    check::that((last.pitch.damping.std > by_delay) == sure, "is in the damping's deviation");
    check::that((last.pitch.damping.std < 0.06 * by_delay) != sure, "and one within it is not");
  }
}

// Deviations are found anew where some seconds of rows end; until then they grow by what the values have moved.
void what_a_value_has_moved_is_in_its_deviation() {
  constexpr double BEGINS = 40.0, CREEPS = 0.5;  // s; N·m/rad a second, in pitch
  FootEstimator estimator(two_feet());
  FootEstimate last;
  for (int i = 0; i < 9120; ++i) {
    const double t = i / 200.0;
    Sensors sensors(t);
    for (auto& w : sensors.wrench) w[4] += CREEPS * std::max(t - BEGINS, 0.0) * angle(0, t);
    last = estimator.step(sensors.reading(t))[0];
  }
  const double moved = last.pitch.stiffness.value - TRUE_STIFFNESS[0];
  check::that(moved > 0.1, "stiffness follows the ground");
  check::near(last.pitch.stiffness.std, moved, 0.05 * moved, "a deviation that knows of it");
  check::that(last.pitch.stiffness.half_width > 1.96 * moved, "and a half width");
  check::near(last.pitch.damping.std, 0.03 / 200 * TRUE_STIFFNESS[0], 1e-3,
              "readings of one tick apart by a share of it");
}

void run() {
  for (const double delay : {0.01, 0.03, -0.01}) a_delay_that_was_told_wrongly_is_seen(delay);
  one_foot_alone_may_be_late(0.015, true), one_foot_alone_may_be_late(0.003, false);
  what_a_value_has_moved_is_in_its_deviation();
  a_delay_within_the_rows_scatter_is_not_told();
}

const check::Listed listed(run);

}  // namespace estimator_delay_test
