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

// A model whose right sole slides forward by a joint that reads `position`.
EstimatorModel with_a_slide(double delay) {
  EstimatorModel model = two_feet(delay);
  model.feet[1].path.push_back({0, true, 1.0, {{0, 0, 1, 0, 1, 0, -1, 0, 0}, {0, 0, 0}}});
  model.feet[1].path.push_back({1, false, 1.0, {{0, 0, -1, 0, 1, 0, 1, 0, 0}, {0, 0, 0}}});
  model.joints = {"slide", "rests"};
  return model;
}

// What speaks against the readings of the ticks from `since` on, for seconds.
void strikes(Sensors& sensors, double* const, double since, int tick) {
  if (since < 0.2) sensors.wrench[0][0] += tick % 2 ? 60.0 : -60.0;
}
void slides(Sensors&, double* const joints, double since, int) { joints[0] += since < 1.0 ? 0.05 * since : 0.05; }
void turns_the_other_way(Sensors& sensors, double* const, double since, int) {
  if (since < 1.0) sensors.gyroscope[1] *= -1.0;
}
void tips(Sensors& sensors, double* const, double since, int) {
  if (since < 0.5) sensors.wrench[0][4] += 60.0;
}

// What is read while something is told against the readings is in no row: neither in the mean of a tick and the one
// before, nor while the delay's lines still hold it.
template <class Change>
void what_is_doubted_is_in_no_row(Change change, std::uint32_t flag, const char* what) {
  for (const double delay : {0.0, -0.02}) {
    std::vector<bool> told(TICKS, false);
    const auto stiffness = [&](double wrong, bool look) {
      FootEstimator estimator(with_a_slide(delay));
      FootEstimate last;
      for (int i = 0; i < TICKS; ++i) {
        const double t = i / HZ;
        Sensors sensors(t, delay);
        double joints[2] = {1e-9 * std::sin(1e5 * t), 1e-9 * std::cos(1e5 * t)};
        if (i > 2400) change(sensors, joints, i % 800 / HZ, i);
        if (told[i]) sensors.wrench[0][4] += wrong;
        Reading reading = sensors.reading(t);
        reading.position = joints;
        last = estimator.step(reading)[0];
        if (look) told[i] = last.flags & flag;
      }
      return last.pitch.stiffness.value;
    };
    const double clean = stiffness(0.0, true);
    check::that(std::count(told.begin(), told.end(), true) > 300, what);
    check::near(stiffness(6.0, false), clean, 1e-9 * clean, what);
  }
}

void run() {
  what_is_outside_a_stance_is_in_no_row();
  what_ends_on_its_edge_is_no_row();
  what_is_doubted_is_in_no_row(strikes, IMPACT, "an impact");
  what_is_doubted_is_in_no_row(slides, SLIP, "a slide");
  what_is_doubted_is_in_no_row(turns_the_other_way, CONTRADICTION, "a gyroscope turned round");
  what_is_doubted_is_in_no_row(tips, EDGE, "a sole on its edge");
}

const check::Listed listed(run);

}  // namespace estimator_rows_test
