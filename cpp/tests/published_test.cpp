// What an estimate's deviations are made of: what was told of gains and delay, and how far samples are apart.
#include <cmath>

#include "check.hpp"
#include "two_feet.hpp"

namespace published_test {

using namespace plantar;

FootEstimate after_a_minute(const EstimatorModel& model, double rate_hz = 200.0) {
  FootEstimator estimator(model);
  FootEstimate last;
  for (int i = 0; i < static_cast<int>(60 * rate_hz); ++i)
    last = estimator.step(Sensors(i / rate_hz).reading(i / rate_hz))[0];
  return last;
}

void near_share(double found, double wanted, const char* what) { check::near(found, wanted, 0.01 * wanted, what); }

// A gain is one of torques alone; a delay takes K times itself off the damping.
void what_was_told_widens() {
  for (const double gain : {0.0, 0.02})
    for (const double delay : {0.0, 0.002}) {
      EstimatorModel model = two_feet();
      model.wrench_gain_std = gain, model.wrench_delay_std = delay;
      const FootEstimate last = after_a_minute(model);
      for (int a = 0; a < 2; ++a) {
        const AxisEstimate& axis = a == 0 ? last.pitch : last.roll;
        const double k = TRUE_STIFFNESS[a], c = TRUE_DAMPING[a], skew = 0.03 / 200.0;
        const double damping = std::sqrt(gain * gain * c * c + k * k * (delay * delay + skew * skew));
        near_share(axis.damping.std, damping, "a damping's deviation");
        near_share(axis.damping.half_width, 1.96 * damping, "and half width");
        if (gain > 0.0) near_share(axis.stiffness.std, gain * k, "a stiffness'");
        if (gain > 0.0) near_share(axis.stiffness.half_width, 1.96 * gain * k, "and half width");
        check::that(axis.identified, "identified");
      }
    }
}

// Each sample is some hundredths of a period off. One pace alone says nothing of a delay: no number comes of rounding.
void samples_apart_leave_the_damping_open() {
  for (const double rate : {50.0, 100.0, 400.0}) {
    const FootEstimate last = after_a_minute(two_feet(), rate);
    near_share(last.pitch.damping.std, 0.03 / rate * TRUE_STIFFNESS[0], "several paces");
    near_share(last.roll.damping.std, 0.03 / rate * TRUE_STIFFNESS[1], "one pace");
  }
}

void a_tenth_of_the_stiffness_is_too_wide() {
  for (const double gain : {0.0505, 0.0515}) {
    EstimatorModel model = two_feet();
    model.wrench_gain_std = gain;
    const FootEstimate last = after_a_minute(model);
    const bool sure = 1.96 * gain < 0.1;
    check::that(last.pitch.identified == sure && last.roll.identified == sure, "identified");
    check::that(last.flags == (sure ? 0 : PITCH_UNKNOWN | ROLL_UNKNOWN), "or unknown");
  }
}

constexpr double COMPLIANCE = 2e-5;

// A slide under a load that changes, pushed aside: the bush's centre rises with it. `told` is known of it before; roll
// shows `more` of it than pitch.
Parameter compliance_learnt(double told, double more) {
  EstimatorModel model = two_feet();
  for (FootModel& foot : model.feet) foot.compliance = told, foot.compliance_std = 2.0 * COMPLIANCE;
  FootEstimator estimator(model);
  FootEstimate last;
  for (int i = 0; i < 12000; ++i) {
    const double t = i / 200.0, x = 60.0 * std::sin(2.7 * t), y = 60.0 * std::sin(3.1 * t);
    const double load = 300.0 + 80.0 * std::sin(1.3 * t);
    Sensors sensors(t, 0.0, load);
    for (auto& w : sensors.wrench)
      w[0] = x, w[1] = y, w[3] -= (COMPLIANCE + more) * load * y, w[4] += COMPLIANCE * load * x;
    last = estimator.step(sensors.reading(t))[0];
  }
  return last.compliance;
}

// No sensor has noise, and still no model has all of what was learnt.
void a_compliance_is_never_sure() {
  for (const double told : {0.0, 0.5 * COMPLIANCE}) {
    const Parameter found = compliance_learnt(told, 0.0);
    near_share(found.value, COMPLIANCE, "a compliance");
    near_share(found.std, 0.07 * (COMPLIANCE - told), "its deviation");
    near_share(found.half_width, 1.96 * 0.07 * (COMPLIANCE - told), "and half width");
  }
  check::that(compliance_learnt(0.0, COMPLIANCE).std > 0.3 * COMPLIANCE, "axes that differ");
}

void a_compliance_that_nothing_shows_has_a_width() {
  const Parameter found = after_a_minute(two_feet()).compliance;
  check::that(std::isfinite(found.std) && std::isfinite(found.half_width), "no compliance, but a number");
}

void run() {
  a_compliance_is_never_sure();
  a_compliance_that_nothing_shows_has_a_width();
  what_was_told_widens();
  samples_apart_leave_the_damping_open();
  a_tenth_of_the_stiffness_is_too_wide();
}

const check::Listed listed(run);

}  // namespace published_test
