// Rubber with a memory, of which the model knows nothing: its torque depends on the way that it has come.
//
// The same rows are fitted once more with a Jenkins element of a usual slip angle beside spring and damper. Whatever
// the rubber's own slip angle is, such an element then takes a part of the torque, where motions go beyond that angle;
// beside a spring and a damper alone it takes none. Within its slip angle rubber is a stiffer spring, and nothing tells
// both apart: what has not moved that far stays untested.
#pragma once

#include <algorithm>

#include "online/axis_regression.hpp"

namespace plantar {

constexpr double SUSPECTED_ANGLE = 0.006;  // rad: rubber feet slip at 2 to 15 mrad
constexpr double TESTING_WAY = 0.03;       // rad, back and forth: what slips at 15 mrad has slipped to and fro
constexpr int GROUPS_FOR_MEMORY = 6;       // that must agree
constexpr double SURE_OF_MEMORY = 4.0;     // deviations of the element's torque
constexpr double SURE_OF_NONE = 2.0;       // deviations, by which it must be below what is worth it
constexpr double WORTH_OF_MEMORY = 0.05;   // of the stiffness, which an element adds before it slips: less is let go
constexpr double FILTER_SETTLED = 0.99;    // of a constant, behind the filter

class MemoryWatch {
 public:
  explicit MemoryWatch(const RegressionPrior& prior) noexcept : regression_(prior) {}

  void add(const RegressionRow& row, double dt) noexcept {
    regression_.add(row, dt);
    if (row.own[OFFSET] < FILTER_SETTLED) return;
    const double angle = row.columns[STIFFNESS];
    low_ = begun_ ? std::min(low_, angle) : angle, high_ = begun_ ? std::max(high_, angle) : angle, begun_ = true;
    way_ = std::max(way_, high_ - low_);
  }
  void close() noexcept { regression_.close(), begun_ = false; }
  void restart() noexcept { regression_.restart(), seen_ = excluded_ = begun_ = false, way_ = 0.0; }
  void set_spread(Unknown unknown, double spread) noexcept { regression_.set_spread(unknown, spread); }

  void work() noexcept {
    regression_.work();
    const AxisValues& found = regression_.values();
    const bool tested = way_ > TESTING_WAY;
    const double torque = found.value[SLIP_TORQUE], least = WORTH_OF_MEMORY * SUSPECTED_ANGLE * found.value[STIFFNESS];
    // Where one motion alone has gone far, leaving it out says nothing: the rows' scatter has to do.
    const double resolved = found.resolved[SLIP_TORQUE];
    const double deviation = tested ? resolved : found.std[SLIP_TORQUE];
    excluded_ = tested && torque + SURE_OF_NONE * resolved < least;
    if (tested || found.groups >= GROUPS_FOR_MEMORY) seen_ = torque > SURE_OF_MEMORY * deviation && torque > least;
  }
  bool seen() const noexcept { return seen_; }
  bool excluded() const noexcept { return excluded_; }
  const AxisValues& values() const noexcept { return regression_.values(); }

 private:
  AxisRegression regression_;
  bool seen_ = false, excluded_ = false;
  bool begun_ = false;                         // a row of this block was seen
  double low_ = 0.0, high_ = 0.0, way_ = 0.0;  // of the deflection in this block, and the longest way in any [rad]
};

}  // namespace plantar
