// Sensors that say nothing: values that are not finite, and readings that stand still while their noise should not.
#pragma once

#include <cmath>
#include <span>

namespace plantar {

constexpr double LARGEST = 1e12;     // in any unit: what no sensor reads
constexpr double FROZEN_TIME = 0.1;  // s without any change: no device is read so rarely
constexpr int FROZEN_SAMPLES = 8;    // and so many samples: a slow log repeats nothing that long
constexpr double FROZEN_WAY = 0.01;  // rad or m that a joint's velocity says it moved while its position stood

inline bool all_finite(std::span<const double> values) noexcept {
  for (const double value : values)
    if (!(std::abs(value) < LARGEST)) return false;
  return true;
}

// Noisy readings of one device: one that repeats all of them is frozen.
template <int SIZE>
class DeviceWatch {
 public:
  bool frozen(std::span<const double> values, double dt) noexcept {
    bool same = true;
    for (int i = 0; i < SIZE; ++i) {
      same = same && values[i] == last_[i];
      last_[i] = values[i];
    }
    time_ = same ? time_ + dt : 0.0;
    samples_ = same ? samples_ + 1 : 0;
    return time_ > FROZEN_TIME && samples_ >= FROZEN_SAMPLES;
  }

 private:
  double last_[SIZE] = {};
  double time_ = 0.0;
  int samples_ = 0;
};

// An encoder may well repeat itself at rest: it is frozen where its velocity says that the joint moved.
class JointWatch {
 public:
  bool frozen(double position, double velocity, double dt) noexcept {
    way_ = position == last_ ? way_ + std::abs(velocity) * dt : 0.0;
    last_ = position;
    return way_ > FROZEN_WAY;
  }

 private:
  double last_ = 0.0, way_ = 0.0;
};

}  // namespace plantar
