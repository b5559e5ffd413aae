// Rubber with a memory, of which the model knows nothing: its torque depends on the way that it has come.
//
// The same rows are fitted once more with a Jenkins element of a usual slip angle beside spring and damper. Whatever the
// rubber's own slip angle is, such an element then takes a part of the torque; beside a spring and a damper alone it
// takes none.
#pragma once

#include "online/axis_regression.hpp"

namespace plantar {

constexpr double SUSPECTED_ANGLE = 0.006;   // rad: rubber feet slip at 2 to 15 mrad
constexpr int GROUPS_FOR_MEMORY = 6;        // that must agree
constexpr double SURE_OF_MEMORY = 4.0;      // deviations of the element's torque
constexpr double WORTH_OF_MEMORY = 0.05;    // of the stiffness, which an element adds before it slips: less is let go

class MemoryWatch {
 public:
  explicit MemoryWatch(const RegressionPrior& prior) noexcept : regression_(prior) {}

  void add(const RegressionRow& row, double dt) noexcept { regression_.add(row, dt); }
  void close() noexcept { regression_.close(); }
  void restart() noexcept { regression_.restart(), seen_ = false; }
  void set_spread(Unknown unknown, double spread) noexcept { regression_.set_spread(unknown, spread); }

  void work() noexcept {
    regression_.work();
    const AxisValues& found = regression_.values();
    if (found.groups < GROUPS_FOR_MEMORY) return;
    const double torque = found.value[SLIP_TORQUE], least = WORTH_OF_MEMORY * SUSPECTED_ANGLE * found.value[STIFFNESS];
    seen_ = torque > SURE_OF_MEMORY * found.std[SLIP_TORQUE] && torque > least;
  }
  bool seen() const noexcept { return seen_; }

 private:
  AxisRegression regression_;
  bool seen_ = false;
};

}  // namespace plantar
