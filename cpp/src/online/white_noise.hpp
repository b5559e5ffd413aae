// White noise of a signal, from its fourth differences: motion is far slower than the samples and leaves nothing there.
#pragma once

#include <cmath>

#include "online/running_quantile.hpp"

namespace plantar {

class WhiteNoise {
 public:
  void restart() noexcept { count_ = 0; }

  void see(double value, double dt) noexcept {
    double next = value;
    for (int order = 0; order < 4; ++order) {
      const double difference = next - last_[order];
      last_[order] = next;
      next = difference;
    }
    if (++count_ > 4) median_.see(std::abs(next), dt);
  }

  double variance() const noexcept {
    const double deviation = median_.value() * (1.0 / 0.6745);  // of normal noise, from the median of its size
    return deviation * deviation * (1.0 / 70.0);                // 1 + 16 + 36 + 16 + 1
  }

 private:
  double last_[4] = {};
  int count_ = 0;
  RunningQuantile median_{0.5, 1.0};
};

}  // namespace plantar
