// States of Jenkins elements along a path.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plantar {

// z in [-1, 1] of Jenkins elements that slip at `slip` (b,), from `start` (r, b). On each branch z = direction·(place -
// 1): `place` is how far z stands from the end it came from, 0 to 2.
class StopOperator {
 public:
  StopOperator(const double* slip, const double* start, std::size_t b) : slip_(slip), start_(start), place_(b) {}

  void begin(std::size_t run, double direction) {
    for (std::size_t k = 0; k < place_.size(); ++k)
      place_[k] = 1.0 + direction * std::clamp(start_[run * place_.size() + k], -1.0, 1.0);
  }
  void turn(double way) {
    for (std::size_t k = 0; k < place_.size(); ++k) place_[k] = std::max(2.0 - (place_[k] + way / slip_[k]), 0.0);
  }
  void states(double direction, double way, double* z) const {
    for (std::size_t k = 0; k < place_.size(); ++k)
      z[k] = direction * (std::min(place_[k] + way / slip_[k], 2.0) - 1.0);
  }

 private:
  const double *slip_, *start_;
  std::vector<double> place_;
};

}  // namespace plantar
