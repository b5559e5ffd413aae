// Whether the force sensors are late by the time that was told: else torques follow deflections otherwise at each
// frequency. Slow motions do not show it. Of the IMU the same, where the body turns otherwise than the feet bend.
#pragma once

#include <algorithm>
#include <cmath>

namespace plantar {

constexpr double LATENESS = 0.005;    // s that spoil a damping by tenths; or a period: readings may be as far apart
constexpr double SURE_OF_LATE = 2.0;  // half widths
constexpr double NORMAL_HALF = 1.96;  // deviations

// By how much readings are later than was told, weighted, and the weight: one over its half width's square.
struct Lateness {
  double sum = 0.0, weight = 0.0;  // [1/s], [1/s²]

  static Lateness of(double value, double half) noexcept {
    return half > 0.0 ? Lateness{value / (half * half), 1.0 / (half * half)} : Lateness{};
  }

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
    const double told = NORMAL_HALF * told_std, half = std::sqrt(1.0 / seen.weight + told * told);
    const double found = std::abs(seen.sum / seen.weight), least = std::max(LATENESS, period);
    return late_ = late_ ? found + half > least : found > std::max(least, SURE_OF_LATE * half);
  }

 private:
  bool late_ = false;
};

}  // namespace plantar
