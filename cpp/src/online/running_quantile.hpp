// A value below which a signal stays for a given share of the time, followed sample by sample.
#pragma once

#include <algorithm>

namespace plantar {

class RunningQuantile {
 public:
  // share: of the time that the signal is below; time: in which the value may follow by its own size [s].
  RunningQuantile(double share, double time) noexcept : share_(share), rate_(1.0 / time) {}

  void see(double size, double dt) noexcept {
    if (value_ <= 0.0) {
      value_ = size;
      return;
    }
    const double step = std::min(dt * rate_, 0.5);
    value_ *= 1.0 + step * (size > value_ ? share_ : share_ - 1.0);
  }

  double value() const noexcept { return value_; }

 private:
  double share_, rate_, value_ = 0.0;
};

}  // namespace plantar
