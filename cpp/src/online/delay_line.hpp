// Values as they were a fixed time ago, between samples in a straight line.
#pragma once

#include <algorithm>
#include <array>

namespace plantar {

constexpr int DELAY_SAMPLES = 512;     // kept: 0.1 s at 5 kHz
constexpr double LONGEST_DELAY = 0.1;  // s: a sensor that is later has another fault

template <int CHANNELS>
class DelayLine {
 public:
  using Values = std::array<double, CHANNELS>;

  void restart() noexcept { count_ = 0; }

  // Takes the values at `time`, gives those at `time - delay`; false while the line does not reach back so far.
  bool pass(double time, const Values& values, double delay, Values& late) noexcept {
    newest_ = (newest_ + 1) % DELAY_SAMPLES;
    times_[newest_] = time, values_[newest_] = values;
    count_ = std::min(count_ + 1, DELAY_SAMPLES);
    late = values;
    if (delay <= 0.0) return true;
    const double wanted = time - delay;
    for (int back = 1; back < count_; ++back) {
      const int before = (newest_ - back + DELAY_SAMPLES) % DELAY_SAMPLES;
      if (times_[before] > wanted) continue;
      const int after = (before + 1) % DELAY_SAMPLES;
      const double share = (wanted - times_[before]) / (times_[after] - times_[before]);
      for (int c = 0; c < CHANNELS; ++c)
        late[c] = values_[before][c] + share * (values_[after][c] - values_[before][c]);
      return true;
    }
    return false;
  }

 private:
  std::array<double, DELAY_SAMPLES> times_ = {};
  std::array<Values, DELAY_SAMPLES> values_ = {};
  int newest_ = 0, count_ = 0;
};

}  // namespace plantar
