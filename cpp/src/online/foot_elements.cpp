// The elements beside a foot's bushes: on the ground, over an edge and through the air.
#include <algorithm>

#include "online/foot_tracker.hpp"

namespace plantar {

namespace {

constexpr double NEWLY_KNOWN = 0.005;  // of an element's range: less changes no offset

}  // namespace

// Elements from tick to tick. Of a foot that stood when time began nobody knows: each time that less is unknown, the
// rows' offset changes; where little is unknown, the rows carry it. A sole that rolls over its edge turns with the
// ankle, and the bush stays about as it is. What a foot lands with is known from how it lifted; it is loaded from there
// until the sole lies flat.
void FootTracker::follow_elements(const Middle& row, double time, double dt) noexcept {
  const double *angles = row.angles.data() + 4, *rates = row.angles.data() + 2;
  if (stood_ && !row.stands) unload_elements();
  stood_ = row.stands;
  bool known = false, suspected = false;
  for (int a = 0; a < 2 && !row.rolls; ++a) {
    ElementState& element = element_[a];
    if (begun_elements_ && (row.stands || row.lands)) {
      if (rolled_) element.hold(angles[a]), opened_[a] = element.gap();
      if (turned(rates_before_[a], rates[a]))
        element.follow(turning_angle(angles_before_[a], rates_before_[a], rates[a], dt));
      element.follow(angles[a]);
      if (row.lands) opened_[a] = element.gap();
      const bool wide = opened_[a] > LEAN / slip_angle_[a];
      if (wide && opened_[a] - element.gap() > NEWLY_KNOWN) (has_element(*foot_, a) ? known : suspected) = true;
    } else if (lifted_) {
      ElementState landed = hanging_[a];
      landed.load(angles[a]);
      element = landed, opened_[a] = element.gap();
    } else {
      element.begin(slip_angle_[a], angles[a]), opened_[a] = element.gap();
    }
  }
  begun_elements_ = true;
  std::copy_n(angles, 2, angles_before_), std::copy_n(rates, 2, rates_before_);
  rolled_ = row.rolls;
  if (!known && !suspected) return;
  commit(time);
  for (int a = 0; a < 2; ++a) opened_[a] = element_[a].gap();
  for (MemoryWatch& memory : memories_) memory.close();
  if (!known) return;
  for (AxisRegression& axis : axes_) axis.close();
  restart_filter();
}

// The foot has lifted.
void FootTracker::unload_elements() noexcept {
  lifted_ = true;
  for (int a = 0; a < 2; ++a) {
    const AxisValues& found = has_element(*foot_, a) ? axes_[a].values() : memories_[a].values();
    lifted_ = lifted_ && found.groups >= FEWEST_GROUPS && found.plausible(STIFFEST * weight_);
    if (!lifted_) return;
    hanging_[a] = element_[a];
    hanging_[a].unload(std::max(found.value[SLIP_TORQUE], 0.0) / found.value[STIFFNESS]);
  }
}

}  // namespace plantar
