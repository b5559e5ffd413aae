// From what rows have found to what is told of it: each number by hand, and each reason to call nothing identified.
#include "online/axis_published.hpp"

#include "check.hpp"

namespace axis_published_test {

using namespace plantar;

constexpr double STUDENT = 2.365;  // of eight groups

AxisValues found() {
  AxisValues values;
  values.groups = 8;
  values.value = {800.0, 20.0, 6.0, 0.0, 0.0, 2e-5, 0.0, 0.0};
  values.grouped = {3.0, 0.7, 0.2, 0.0, 0.0, 1e-6, 0.0, 0.0};
  values.std = {4.0, 0.8, 0.3, 0.0, 0.0, 2e-6, 0.0, 0.0};
  values.told = {1.0, 0.3, 0.1, 0.0, 0.0, 5e-7, 0.0, 0.0};
  values.moved = {2.0, 0.5, 0.05, 0.0, 0.0, 3e-7, 0.0, 0.0};
  values.by_late = {50.0, -900.0};
  values.by_element = 3.0;
  values.late = {2e-3, 1e-3, 0.0}, values.turned = {1.6, 0.4, 0.0};
  return values;
}

AxisFacts facts(double slip_angle = 0.0, std::array<double, 2> unsure = {}) {
  return {600.0, 0.01, 1e-3, 0.005, unsure, slip_angle, true, false, false};
}

void same(const Parameter& is, double value, double std, double rows, double told, double beside, const char* what) {
  check::near(is.value, value, 1e-12 * std::abs(value), what);
  check::near(is.std, std::hypot(std, beside), 1e-9 * std, what);
  const double half = std::hypot(std::hypot(rows, 1.96 * told), 1.96 * beside);
  check::near(is.half_width, half, 1e-9 * half, what);
}

// The wrench's gain is a share of each torque, what joints that bend leave open one of each number. Rows show a
// lateness only beyond its half width, and beside an element they do not say whose torque it is.
void every_cause_has_its_part() {
  const AxisValues values = found();
  const std::array<double, 2> unsure = {0.03, 0.04};
  for (const double slip_angle : {0.0, 0.01}) {
    const AxisPublished is = published(values, facts(slip_angle, unsure));
    AxisValues later = values;
    later.late.value = -5e-3;
    const double shown = slip_angle > 0.0 ? 0.0 : 5e-3 - STUDENT * 1e-3;
    for (const bool late : {false, true}) {
      const double seconds = std::hypot(std::hypot(1e-3, 0.03 * 0.005), late ? shown : 0.0);
      const AxisPublished one = late ? published(later, facts(slip_angle, unsure)) : is;
      const double of_k = std::hypot(std::hypot(2.0, 8.0, seconds * 50.0), 800.0 * unsure[0]);
      const double of_c = std::hypot(std::hypot(0.5, 0.2, seconds * 900.0), 20.0 * unsure[1]);
      same(one.stiffness, 800.0, 4.0, STUDENT * 3.0, 1.0, of_k, "a stiffness");
      same(one.damping, 20.0, 0.8, STUDENT * 0.7, 0.3, of_c, "a damping");
    }
    if (slip_angle > 0.0) same(is.slip_torque, 6.0, 0.3, STUDENT * 0.2, 0.1, std::hypot(0.05, 0.06), "a slip torque");
    if (slip_angle == 0.0) check::that(is.slip_torque.half_width == 0.0, "no slip torque without an element");
  }
}

// An expectation that holds back half of a compliance's way leaves as much again open; one that holds all of it, nearly
// everything.
void a_compliance_that_is_held_back_is_open() {
  AxisValues values = found();
  for (const double held : {-0.2, 0.0, 0.5, 0.8, 1.0}) {
    values.held = held;
    const double beside = held <= 0.0 ? 0.0 : held < 1.0 ? 2e-5 * held / (1.0 - held) : 2e-5 * 999.0;
    same(published(values, facts()).compliance, 2e-5, 2e-6, STUDENT * 1e-6, 5e-7, std::hypot(3e-7, beside), "a slide");
  }
}

// Half a tenth of K, with twice as much to each side.
void a_stiffness_is_sure_where_it_is_known_and_one_of_a_bush() {
  const auto sure = [](auto change) {
    AxisValues values = found();
    change(values);
    const AxisPublished is = published(values, facts());
    check::that(is.identified == is.sure, "what is not sure is not identified");
    return is.sure;
  };
  check::that(sure([](AxisValues&) {}), "known");
  check::that(!sure([](AxisValues& v) { v.grouped[STIFFNESS] = 80.0 / STUDENT; }), "a tenth is too wide");
  check::that(sure([](AxisValues& v) { v.grouped[STIFFNESS] = 70.0 / STUDENT; }), "less is not");
  check::that(sure([](AxisValues& v) { v.groups = 3, v.grouped[STIFFNESS] = 1.0; }), "three groups say how they differ");
  check::that(!sure([](AxisValues& v) { v.groups = 2, v.grouped[STIFFNESS] = 1.0; }), "two do not");
  check::that(sure([](AxisValues& v) { v.value[STIFFNESS] = 59e3, v.value[DAMPING] = 0.0; }), "stiff");
  check::that(!sure([](AxisValues& v) { v.value[STIFFNESS] = 61e3, v.value[DAMPING] = 0.0; }), "no bush is so stiff");
  check::that(!sure([](AxisValues& v) { v.value[STIFFNESS] = -800.0; }), "nor pushes the other way");
}

// Known numbers are told as identified only where nothing speaks against the model.
void a_memory_and_a_delay_speak_against_it() {
  for (const double slip_angle : {0.0, 0.01})
    for (const bool without : {false, true})
      for (const bool memory : {false, true})
        for (const bool late : {false, true}) {
          AxisFacts now = facts(slip_angle);
          now.without_memory = without, now.has_memory = memory, now.is_late = late;
          const AxisPublished is = published(found(), now);
          const bool modelled = without || slip_angle > 0.0;
          check::that(is.sure && is.tested == modelled, "sure, and tested where memories are modelled or excluded");
          check::that(is.identified == (modelled && !memory && !late), "identified");
          check::that((is.late.weight > 0.0) == (modelled && !memory), "a memory delays torques, too");
          check::that((is.late_imu.weight > 0.0) == (modelled && !memory), "and deflections");
        }
  AxisValues values = found();
  for (const double by_element : {7.9, 8.1}) {
    values.by_element = by_element / 1.96;
    check::that(published(values, facts(0.01)).tested == (by_element < 8.0), "a torque that was told says a hundredth");
    check::that(published(values, facts()).tested, "without an element there is none");
  }
}

// Within its slip angle an element is a spring of its torque over that angle.
void lateness_is_told_with_its_weight() {
  AxisValues values = found();
  for (const double slip_angle : {0.0, 0.01}) {
    const AxisPublished is = published(values, facts(slip_angle));
    const double stiffest = slip_angle > 0.0 ? 1400.0 : 800.0, half = STUDENT * 0.4 / stiffest;
    check::near(is.late.sum / is.late.weight, 2e-3, 1e-12, "of torques");
    check::near(1.0 / std::sqrt(is.late.weight), STUDENT * 1e-3, 1e-12, "and its half width");
    check::near(is.late_imu.sum / is.late_imu.weight, 1.6 / stiffest, 1e-12, "of the IMU");
    check::near(1.0 / std::sqrt(is.late_imu.weight), half, 1e-12, "and its half width");
  }
  values.grouped[STIFFNESS] = 80.0;
  check::that(published(values, facts()).late.weight > 0.0, "a torque needs no stiffness");
  check::that(published(values, facts()).late_imu.weight == 0.0, "an IMU's delay is told by a stiffness that is known");
  values.groups = 2;
  check::that(published(values, facts()).late.weight == 0.0, "too few groups");
}

void a_stiffness_is_a_bushs_between_nothing_and_the_stiffest() {
  AxisValues values;
  for (const double stiffness : {-1.0, 0.0, 1e-3, 999.0, 1000.0, 2000.0}) {
    values.value[STIFFNESS] = stiffness;
    check::that(values.plausible(1000.0) == (stiffness > 0.0 && stiffness < 999.5), "whether a stiffness is plausible");
  }
}

void run() {
  a_stiffness_is_a_bushs_between_nothing_and_the_stiffest();
  every_cause_has_its_part();
  a_compliance_that_is_held_back_is_open();
  a_stiffness_is_sure_where_it_is_known_and_one_of_a_bush();
  a_memory_and_a_delay_speak_against_it();
  lateness_is_told_with_its_weight();
}

const check::Listed listed(run);

}  // namespace axis_published_test
