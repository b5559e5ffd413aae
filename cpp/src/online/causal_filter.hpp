// A causal Butterworth low-pass of fourth order on several channels at once.
//
// Every channel of a regression passes the same filter from the same state, zero: what is true between the channels at
// each instant stays true between their filtered values, through the transient too, and no delay needs compensation.
// A constant is a channel like the others.
#pragma once

#include <cmath>
#include <numbers>

namespace plantar {

constexpr double FILTER_REACH = 0.45;  // of the sampling rate: a higher cutoff filters nothing

struct Biquad {
  double b = 1.0, a1 = 0.0, a2 = 0.0;  // y = b (x + 2 x[-1] + x[-2]) - a1 y[-1] - a2 y[-2]
};

template <int CHANNELS>
class CausalFilter {
 public:
  void design(double cutoff, double period) noexcept {
    passes_all_ = !(cutoff * period < FILTER_REACH);
    const double k = std::tan(std::numbers::pi * cutoff * period);
    const double damping[2] = {2.0 * std::sin(std::numbers::pi / 8), 2.0 * std::sin(3 * std::numbers::pi / 8)};
    for (int s = 0; s < 2; ++s) {
      const double scale = 1.0 / (1.0 + damping[s] * k + k * k);
      sections_[s] = {k * k * scale, 2.0 * (k * k - 1.0) * scale, (1.0 - damping[s] * k + k * k) * scale};
    }
  }

  void restart() noexcept {
    for (auto& section : memory_)
      for (auto& values : section) values[0] = values[1] = 0.0;
  }

  // In place (transposed direct form II).
  void pass(double (&values)[CHANNELS]) noexcept {
    if (passes_all_) return;
    for (int s = 0; s < 2; ++s) {
      const Biquad& q = sections_[s];
      for (int c = 0; c < CHANNELS; ++c) {
        double (&m)[2] = memory_[s][c];
        const double x = q.b * values[c], y = x + m[0];
        m[0] = 2.0 * x - q.a1 * y + m[1];
        m[1] = x - q.a2 * y;
        values[c] = y;
      }
    }
  }

 private:
  bool passes_all_ = true;
  Biquad sections_[2];
  double memory_[2][CHANNELS][2] = {};
};

}  // namespace plantar
