// What 95 % intervals are made of, and what both axes of a foot say of the same number.
#pragma once

#include <algorithm>
#include <cmath>

#include "plantar/foot_estimator.hpp"

namespace plantar {

constexpr double NORMAL = 1.96;
constexpr double UNMODELLED = 0.07;  // of a learnt compliance: what the model leaves where no sensor has noise
// Student's t for 95 %, by degrees of freedom from 2.
constexpr double QUANTILE[] = {4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201};

// Deviations of independent causes; none comes near the ends of a double's range.
inline double together(double a, double b, double c = 0.0) noexcept { return std::sqrt(a * a + b * b + c * c); }

// Half of an interval by rows: by how much so many groups of them differ, but no less than white noise leaves.
inline double half_of_rows(int groups, double grouped, double white) noexcept {
  return std::max(QUANTILE[std::clamp(groups - 1, 2, 11) - 2] * grouped, NORMAL * white);
}

// The compliance of a foot [m/N], beside what was `told` of it. Both axes have learnt it, each with a prior of its own,
// from torques of the same load. The horizontal forces' torque is hundredths of a newton metre: there the axes differ
// by more than each knows of itself, and both by what no model has.
inline Parameter learnt_by_both(const Parameter& pitch, const Parameter& roll, double told) noexcept {
  const double p = pitch.std * pitch.std, r = roll.std * roll.std, share = r > 0.0 ? r / (p + r) : 0.0;
  const double value = share * pitch.value + (1.0 - share) * roll.value;
  const double apart = std::sqrt(share * (1.0 - share)) * std::abs(pitch.value - roll.value);
  const double beside = together(apart, UNMODELLED * value);
  return {told + value, together(std::min(pitch.std, roll.std), beside),
          together(std::min(pitch.half_width, roll.half_width), NORMAL * beside)};
}

}  // namespace plantar
