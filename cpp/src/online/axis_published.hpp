// What an axis' regression has found, as estimates: intervals, and what may be called identified.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "online/axis_regression.hpp"
#include "online/delay_watch.hpp"
#include "online/half_widths.hpp"

namespace plantar {

constexpr double STIFFEST = 100.0;  // m, times the weight: stiffness before any data
// Of a period: how far apart the readings of one tick are, and how far a sample is from what it stands for: motors
// that are told something new at each tick shake the joints in step with the samples.
constexpr double SKEW = 0.03;
constexpr double TRUSTED = 0.1;  // half width over stiffness
constexpr double TOLD = 0.01;    // the same, by what was told of the element alone: a tenth of that
constexpr double MOST_HELD = 0.999;  // of a compliance, by what was expected of it: beyond, nothing was learnt

// What is known of an axis beside its rows.
struct AxisFacts {
  double weight;                             // of the robot [N]
  double gain_std, delay_std, period;        // of the force sensor [1, s], of the ticks [s]
  std::array<double, 2> unsure;              // deviation of stiffness and damping beside [share]
  double slip_angle;                         // of the model's element [rad]; 0: it has none
  bool without_memory, has_memory, is_late;  // told or shown to have none; rows show one; told to be late
};

struct AxisPublished {
  Parameter stiffness, damping, slip_torque;
  Parameter compliance;     // of the slide beside the model's
  Lateness late, late_imu;  // of the torques, of the IMU
  bool sure, tested, identified;
};

inline AxisPublished published(const AxisValues& found, const AxisFacts& facts) noexcept {
  const double k = found.value[STIFFNESS], c = found.value[DAMPING], slip_torque = found.value[SLIP_TORQUE];
  const bool element = facts.slip_angle > 0.0;
  const auto parameter = [&](Unknown unknown, double systematic) {
    const double rows = half_of_rows(found.groups, found.grouped[unknown], found.white[unknown]);
    const double beside = together(found.moved[unknown], systematic);
    return Parameter{found.value[unknown], together(found.std[unknown], beside),
                     together(rows, NORMAL * found.told[unknown], NORMAL * beside)};
  };
  // A wrench that is late by more than it was told to be takes K·delay off the damping and adds C·ω²·delay to K; where
  // an element does not slip, it is as stiff as K and more.
  // Which of a spring's torques and those of an element that hardly slips is late, rows do not say.
  const auto half_of = [&](const Untold& one) { return half_of_rows(found.groups, one.grouped, one.white); };
  const double late_half = half_of(found.late), turned_half = half_of(found.turned);
  const double surely = element ? 0.0 : std::max(std::abs(found.late.value) - late_half, 0.0);
  const double late = together(facts.delay_std, SKEW * facts.period, surely);
  AxisPublished out = {};
  const double of_k = facts.unsure[0] * k, of_c = facts.unsure[1] * c;
  out.stiffness = parameter(STIFFNESS, together(facts.gain_std * k, late * found.by_late[STIFFNESS], of_k));
  out.damping = parameter(DAMPING, together(facts.gain_std * c, late * found.by_late[DAMPING], of_c));
  if (element) out.slip_torque = parameter(SLIP_TORQUE, facts.gain_std * slip_torque);
  // A slide that is softer than anyone expects is held back by that expectation, whose deviation says nothing of it.
  const double held = std::clamp(found.held, 0.0, MOST_HELD);
  out.compliance = parameter(COMPLIANCE, found.value[COMPLIANCE] * held / (1.0 - held));
  const bool groups_differ = found.groups >= FEWEST_GROUPS;
  out.sure = groups_differ && found.plausible(STIFFEST * facts.weight) && out.stiffness.half_width < TRUSTED * k;
  // Within its slip angle an element is a stiffer spring: what is the spring's and what the element's, only the torque
  // says that was told. A memory that is not modelled delays torques, too.
  out.tested = element ? NORMAL * found.by_element < TOLD * k : facts.without_memory;
  const bool shows = (element || facts.without_memory) && !facts.has_memory && groups_differ;
  if (shows) out.late = Lateness::of(found.late.value, late_half);
  // Where an element does not slip, more torque hangs on the angle: there the IMU is later than by this at least.
  const double stiffest = k + (element ? slip_torque / facts.slip_angle : 0.0);
  if (shows && out.sure) out.late_imu = Lateness::of(found.turned.value / stiffest, turned_half / stiffest);
  out.identified = out.sure && out.tested && !facts.has_memory && !facts.is_late;
  return out;
}

}  // namespace plantar
