// A Jenkins element against its own law in small steps, on the ground and in the air.
#include "online/element_state.hpp"

#include <algorithm>
#include <cmath>

#include "check.hpp"

namespace element_state_test {

using plantar::ElementState;

constexpr double SLIP = 0.01, STIFFNESS = 434.0, TORQUE = 5.0;

// Bends a bush from rest to `angle`; then takes the torque away in small steps of a damped bush without load.
struct Rubber {
  double state = 0.0, angle = 0.0;

  void bend(double to) {
    const double by = (to - angle) / 1000;
    for (int i = 0; i < 1000; ++i) state = std::clamp(state + by / SLIP, -1.0, 1.0), angle += by;
  }
  void hang() {
    for (int i = 0; i < 20000; ++i) {
      const double by = -1e-6 * (STIFFNESS * angle + TORQUE * state);
      state = std::clamp(state + by / SLIP, -1.0, 1.0), angle += by;
    }
  }
};

void run() {
  for (const double first : {0.004, 0.02, -0.03, 0.06})
    for (const double landing : {-0.02, 0.0, 0.005, 0.03}) {
      Rubber rubber;
      ElementState element;
      element.begin(SLIP, 0.0);
      for (const double there : {0.05, -0.05, 0.0, first}) rubber.bend(there), element.load(there);
      check::near(element.gap(), 0.0, 1e-12, "who has slipped to and fro is known");
      check::near(element.state(), rubber.state, 1e-9, "on the ground");
      rubber.hang(), element.unload(TORQUE / STIFFNESS);
      check::that(std::abs(element.state() - rubber.state) <= element.gap() + 1e-3, "in the air");
      rubber.bend(landing), element.load(landing);
      check::that(std::abs(element.state() - rubber.state) <= element.gap() + 1e-3, "behind the landing");
      check::that(element.gap() < 0.25, "as well as the attitude leans");
    }
  // An angle that turns round between two samples, of which each is the mean of both ends of its period.
  for (const double late : {0.3, 0.5, 0.8}) {
    constexpr double DT = 0.01, BENDS = -40.0;  // s, rad/s²
    const auto at = [late](double t) { return 0.02 + 0.5 * BENDS * std::pow(t - late * DT, 2); };
    const auto mean = [at](double t) { return 0.5 * (at(t - 0.5 * DT) + at(t + 0.5 * DT)); };
    const double before = BENDS * -late * DT, rate = BENDS * (1.0 - late) * DT;
    check::that(plantar::turned(before, rate) && !plantar::turned(rate, rate), "it turns where its rates differ in sign");
    check::near(plantar::turning_angle(mean(0.0), before, rate, DT), 0.02, 1e-12, "as far as it went");
  }
  ElementState unknown;
  unknown.begin(SLIP, 0.003);
  check::near(unknown.gap(), 1.0, 1e-12, "nobody knows");
  unknown.load(0.013);
  check::near(unknown.gap(), 0.5, 1e-12, "half of it is known");
  unknown.hold(0.5), unknown.load(0.5);
  check::near(unknown.gap(), 0.75, 1e-12, "a sole that rolls bends nothing, but one does not know");
  // From end to end in steps of 0.4 slip angles: the mean of both ends of each, also where it begins to slip.
  for (const double begins : {0.0, 0.3, 0.7}) {
    const auto at = [begins](int tick) { return 0.4 * SLIP * (tick + begins); };
    const auto state = [at](int tick) { return std::min(at(tick) / SLIP - 1.0, 1.0); };
    ElementState element;
    element.begin(SLIP, 5.0 * SLIP), element.load(0.0), element.load(0.5 * (at(0) + at(1)));
    for (int tick = 1; tick < 9; ++tick) {
      check::near(element.state(), 0.5 * (state(tick - 1) + state(tick)), 1e-12, "the mean of both ends");
      element.follow(0.5 * (at(tick) + at(tick + 1)));
    }
  }
}

const check::Listed listed(run);

}  // namespace element_state_test
