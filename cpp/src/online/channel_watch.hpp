// Sensors that say nothing: values that are not finite, and readings that stand still while their noise should not.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace plantar {

constexpr double LARGEST = 1e12;                       // in any unit: what no sensor reads
constexpr double FROZEN_TIME = 0.1;                    // s without any change: no device is read so rarely
constexpr int FROZEN_SAMPLES = 8;                      // and so many samples: a slow log repeats nothing that long
constexpr double NOISY_TIME = 10.0;                    // s, in which a noisy channel repeats itself
constexpr double NOISY_REPEATS = 0.01;                 // so rarely
constexpr double WHOLE_TURN = 2.0 * std::numbers::pi;  // rad: no joint of a leg turns further: those are degrees
constexpr double FROZEN_WAY = 0.01;  // rad or m that a joint's velocity says it moved while its position stood
constexpr double TWIN_MOVED = 0.02;  // rad or m that the other leg's joint has moved, while this one never did by a bit

inline bool all_finite(std::span<const double> values) noexcept {
  for (const double value : values)
    if (!(std::abs(value) < LARGEST)) return false;
  return true;
}

// Noisy readings of one device: one that repeats all of them is frozen; so is a channel that repeats itself and has
// hardly ever done so before, but for zeros: a simulated foot in the air reads them.
template <int SIZE>
class DeviceWatch {
 public:
  bool frozen(std::span<const double> values, double dt) noexcept {
    bool all = true, one = false;
    for (int i = 0; i < SIZE; ++i) {
      Channel& channel = channels_[i];
      const bool same = values[i] == channel.last;
      channel.last = values[i];
      channel.time = same ? channel.time + dt : 0.0, channel.samples = same ? channel.samples + 1 : 0;
      const bool stuck = channel.time > FROZEN_TIME && channel.samples >= FROZEN_SAMPLES;
      all = all && stuck;
      one = one || (stuck && values[i] != 0.0 && channel.seen > NOISY_TIME && channel.repeats < NOISY_REPEATS);
      if (stuck) continue;
      const double news = dt / std::clamp(channel.seen + dt, std::max(dt, 1e-9), NOISY_TIME);
      channel.seen += dt, channel.repeats += std::min(news, 1.0) * (same - channel.repeats);
    }
    return all || one;
  }

 private:
  struct Channel {
    double last = 0.0, time = 0.0;
    int samples = 0;
    double seen = 0.0, repeats = 0.0;  // s in which it was not frozen; the share of readings that repeat the last one
  };
  Channel channels_[SIZE];
};

// An encoder may well repeat itself at rest: it is frozen where its velocity says that the joint moved, or where it has
// not changed by a bit since the first tick and the same joint of another leg has moved.
class JointWatch {
 public:
  // Time begins anew, perhaps elsewhere. Nobody mends an encoder in between: one that was dead is, until it moves.
  void restart() noexcept { way_ = 0.0, begun_ = false; }

  bool frozen(double position, double velocity, double dt) noexcept {
    way_ = begun_ && position == last_ ? way_ + std::abs(velocity) * dt : 0.0;
    if (begun_ && position != last_) dead_ = false;
    last_ = position;
    low_ = begun_ ? std::min(low_, position) : position, high_ = begun_ ? std::max(high_, position) : position;
    begun_ = true;
    return way_ > FROZEN_WAY;
  }
  // Whether it has never moved, although its twin has.
  bool dead(const JointWatch& twin) noexcept {
    dead_ = dead_ || (begun_ && high_ == low_ && twin.begun_ && twin.high_ - twin.low_ > TWIN_MOVED);
    return dead_;
  }

 private:
  double last_ = 0.0, way_ = 0.0, low_ = 0.0, high_ = 0.0;
  bool begun_ = false, dead_ = false;
};

}  // namespace plantar
