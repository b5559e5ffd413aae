// The share of a step that a low-pass of first order has followed after a while.
#pragma once

#include <cmath>
#include <numbers>

namespace plantar {

constexpr double FEW_TERMS = 0.4;  // up to here eight terms of its series give it to 2e-9

// 1 - exp(-times): of a step that was `times` time constants ago.
inline double followed_after(double times) noexcept {
  if (!(times < FEW_TERMS)) return 1.0 - std::exp(-times);
  double left = 1.0;
  for (int order = 8; order > 1; --order) left = 1.0 - times * (1.0 / order) * left;
  return times * left;
}

// The same of a low-pass whose band ends at `band` [Hz].
inline double followed_in_band(double band, double dt) noexcept {
  return followed_after(2.0 * std::numbers::pi * band * dt);
}

}  // namespace plantar
