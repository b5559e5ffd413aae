// Whether the force sensors are late by the time that was told: else torques follow deflections otherwise at each
// frequency. Slow motions do not show it.
#pragma once

#include <algorithm>
#include <cmath>

namespace plantar {

constexpr double LATENESS = 0.005;    // s that spoil a damping by tenths; or a period: readings may be as far apart
constexpr double SURE_OF_LATE = 2.0;  // half widths
constexpr double NORMAL_HALF = 1.96;  // deviations

// By how much torques are later than was told, weighted, and the weight: one over its half width's square.
struct Lateness {
  double sum = 0.0, weight = 0.0;  // [1/s], [1/s²]

  Lateness& operator+=(const Lateness& other) noexcept {
    sum += other.sum, weight += other.weight;
    return *this;
  }
};

class DelayWatch {
 public:
  // seen: of one foot or of several, whose delay was told within `told_std` [s]. A doubt stands until readings exclude
  // it.
  bool late(const Lateness& seen, double told_std, double period) noexcept {
    if (!(seen.weight > 0.0)) return late_;
    const double half = std::hypot(1.0 / std::sqrt(seen.weight), NORMAL_HALF * told_std);
    const double found = std::abs(seen.sum / seen.weight), least = std::max(LATENESS, period);
    return late_ = late_ ? found + half > least : found > std::max(least, SURE_OF_LATE * half);
  }

 private:
  bool late_ = false;
};

}  // namespace plantar
