// States of Bouc-Wen elements along branches: one tabulated curve from -1 to 1, mirrored for the way back.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace plantar {

// Values over places `at` (m,), which never fall: linear between them, and constant beyond.
class Table {
 public:
  Table(const double* at, std::size_t m) : at_(at), last_(m - 1), from_(CELLS + 2, 0) {
    for (std::size_t cell = 0, i = 0; cell < from_.size(); ++cell) {
      while (i < last_ && at[i + 1] <= edge(cell)) ++i;
      from_[cell] = i;
    }
  }

  // The value at x of a curve that goes on from `first` in steps of `step`, one for each place.
  double value(double x, const double* first, std::ptrdiff_t step) const {
    const auto value = [&](std::size_t i) { return first[static_cast<std::ptrdiff_t>(i) * step]; };
    if (!(x > at_[0])) return value(0);
    if (!(x < at_[last_])) return value(last_);
    const auto cell = static_cast<std::size_t>((x - at_[0]) / (at_[last_] - at_[0]) * CELLS);
    // One cell to either side: an edge may be rounded.
    const double* low = at_ + from_[cell > 0 ? cell - 1 : 0];
    const double* high = at_ + std::min(from_[std::min<std::size_t>(cell + 2, CELLS + 1)] + 1, last_);
    const auto i = static_cast<std::size_t>(std::upper_bound(low, high, x) - at_ - 1);
    return value(i) + (value(i + 1) - value(i)) / (at_[i + 1] - at_[i]) * (x - at_[i]);
  }

 private:
  static constexpr std::size_t CELLS = 4096;
  double edge(std::size_t cell) const {
    return at_[0] + (at_[last_] - at_[0]) * static_cast<double>(cell) / static_cast<double>(CELLS);
  }

  const double* at_;
  std::size_t last_;
  std::vector<std::size_t> from_;  // of each cell, the last place at or before its lower edge
};

// The curve's `state` (m,) over its `place` (m,), p = 1 - exp(-pace·way): along a branch 1 - p falls by exp(-pace·way),
// and a turn takes a place to the one of the opposite state. b variants of `pace` (b,), from z = `start` (r, b).
class BranchCurve {
 public:
  BranchCurve(const double* place, const double* state, std::size_t m, const double* pace, const double* start,
              std::size_t b)
      : by_place_(place, m), by_state_(state, m), place_(place), state_(state), back_(place + m - 1), pace_(pace),
        start_(start), left_(b) {}

  void begin(std::size_t run, double direction) {
    for (std::size_t k = 0; k < left_.size(); ++k) {
      const double z = std::clamp(start_[run * left_.size() + k], -1.0, 1.0);
      left_[k] = 1.0 - by_state_.value(direction * z, place_, 1);
    }
  }
  void turn(double way) {
    for (std::size_t k = 0; k < left_.size(); ++k)
      left_[k] = 1.0 - by_place_.value(1.0 - left_[k] * std::exp(-way * pace_[k]), back_, -1);
  }
  void states(double direction, double way, double* z) const {
    for (std::size_t k = 0; k < left_.size(); ++k)
      z[k] = direction * by_place_.value(1.0 - left_[k] * std::exp(-way * pace_[k]), state_, 1);
  }

 private:
  Table by_place_, by_state_;
  const double *place_, *state_, *back_, *pace_, *start_;
  std::vector<double> left_;
};

}  // namespace plantar
