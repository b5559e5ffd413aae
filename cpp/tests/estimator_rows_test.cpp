// Which ticks of a foot that steps its regressions are given: none from before it stood, none on its edge.
#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "two_feet.hpp"

namespace estimator_rows_test {

using namespace plantar;

constexpr double STANCE = 2.0, STEP = 2.4, HZ = 200.0;  // s
constexpr int TICKS = 48 * 200;

double since(double t) { return std::fmod(t, STEP); }

// The left foot steps, as `change(sensors, tick, t)` has its readings; `seen(estimate, tick)` after each.
template <class Change, class Seen>
FootEstimate steps(Change change, Seen seen) {
  FootEstimator estimator(two_feet());
  FootEstimate last;
  for (int i = 0; i < TICKS; ++i) {
    const double t = i / HZ;
    Sensors sensors(t);
    if (since(t) >= STANCE)
      for (double& part : sensors.wrench[0]) part = 1e-6 * std::sin(1e5 * t + part);
    change(sensors, i, t);
    last = estimator.step(sensors.reading(t))[0];
    seen(last, i);
  }
  return last;
}

// A torque that is wrong until two ticks before the foot stands is in no row: a row is the mean of two ticks. Nor one
// that is while it lifts.
void what_is_outside_a_stance_is_in_no_row() {
  std::vector<int> begun;
  bool stood = false;
  const FootEstimate clean = steps([](Sensors&, int, double) {}, [&](const FootEstimate& foot, int tick) {
    const bool stands = foot.contact == ContactState::stance;
    if (stands && !stood) begun.push_back(tick);
    stood = stands;
  });
  check::that(begun.size() > 10, "many stances");
  for (const int before : {1, 2}) {
    std::size_t next = 0;
    const FootEstimate found = steps(
        [&](Sensors& sensors, int tick, double) {
          if (next < begun.size() && tick == begun[next] - before) sensors.wrench[0][4] += 12.0, ++next;
        },
        [](const FootEstimate&, int) {});
    const bool same = std::abs(found.pitch.stiffness.value - clean.pitch.stiffness.value) < 1e-9 * TRUE_STIFFNESS[0];
    check::that(same == (before == 2), "two ticks before, and not the last one");
  }
  const FootEstimate lifts = steps(
      [](Sensors& sensors, int, double t) {
        if (since(t) > STANCE - 0.15 && since(t) < STANCE) sensors.wrench[0][4] += 12.0;
      },
      [](const FootEstimate&, int) {});
  check::near(lifts.pitch.stiffness.value, clean.pitch.stiffness.value, 1e-9 * TRUE_STIFFNESS[0], "nor what is before a lift");
}

// Where the centre of pressure reads beside the sole until the foot lifts, it has tipped: however long that takes.
// Where it comes back, the sensor is not where it was told to be.
void what_ends_on_its_edge_is_no_row() {
  for (const bool back : {false, true}) {
    const FootEstimate found = steps(
        [back](Sensors& sensors, int, double t) {
          const double s = since(t);
          if (s < 0.9 || s > (back ? 1.6 : STANCE)) return;
          sensors.wrench[0][4] += 75.0 + 300.0 * angle(0, t);
        },
        [](const FootEstimate&, int) {});
    const double off = std::abs(found.pitch.stiffness.value - TRUE_STIFFNESS[0]);
    check::that(back ? off > 50.0 : off < 5.0, back ? "rows of a sensor that is elsewhere" : "no rows of an edge");
  }
}

// What is read in an impact is in no row: neither in the mean of a tick and the one before, nor while the delay's lines
// still hold it.
void what_is_read_in_an_impact_is_in_no_row() {
  for (const double delay : {0.0, -0.02}) {
    std::vector<bool> struck(TICKS, false);
    const auto stiffness = [&](double wrong, bool look) {
      FootEstimator estimator(two_feet(delay));
      FootEstimate last;
      for (int i = 0; i < TICKS; ++i) {
        const double t = i / HZ;
        Sensors sensors(t, delay);
        if (i % 800 < 40 && i > 2000) sensors.wrench[0][0] += i % 2 ? 60.0 : -60.0;
        if (struck[i]) sensors.wrench[0][4] += wrong;
        last = estimator.step(sensors.reading(t))[0];
        if (look) struck[i] = last.flags & IMPACT;
      }
      return last.pitch.stiffness.value;
    };
    const double clean = stiffness(0.0, true);
    check::that(std::count(struck.begin(), struck.end(), true) > 500, "many ticks in impacts");
    check::near(stiffness(12.0, false), clean, 1e-9 * clean, "a torque that is wrong in all of them");
  }
}

void run() {
  what_is_outside_a_stance_is_in_no_row();
  what_ends_on_its_edge_is_no_row();
  what_is_read_in_an_impact_is_in_no_row();
}

const check::Listed listed(run);

}  // namespace estimator_rows_test
