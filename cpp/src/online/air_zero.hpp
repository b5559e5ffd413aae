// The zero of a force sensor, read while its foot swings: causal, from the middle of each swing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace plantar {

constexpr double SWING_PIECE = 0.05;  // s: the first piece of a swing and the last ones may still touch the ground
constexpr double CALM_AIR = 0.05;     // of the weight: what a lifted foot reads changes by less
constexpr double LARGEST_ZERO = 0.2;  // of the weight: a foot that reads more is loaded, whatever the sign
constexpr int SWINGS_REMEMBERED = 8;  // the zero drifts

class AirZero {
 public:
  using Wrench = std::array<double, 6>;

  const Wrench& value() const noexcept { return zero_; }
  bool known() const noexcept { return swings_ > 0; }

  // One sample in the air; `load`: its vertical force [N].
  void swing(const Wrench& raw, double load, double weight, double dt) noexcept {
    for (int i = 0; i < 6; ++i) piece_[i] += raw[i];
    least_ = count_ == 0 ? load : std::min(least_, load);
    most_ = count_ == 0 ? load : std::max(most_, load);
    ++count_, time_ += dt;
    if (time_ < SWING_PIECE) return;
    const double mean[3] = {piece_[0] / count_, piece_[1] / count_, piece_[2] / count_};
    const double force = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    // A piece counts once the next one is full: the last one ends with the landing.
    if (pieces_ > 1)
      for (int i = 0; i < 6; ++i) sum_[i] += before_[i];
    pieces_ = most_ - least_ < CALM_AIR * weight && force < LARGEST_ZERO * weight ? pieces_ + 1 : 0;
    if (pieces_ == 0) sum_ = {};
    for (int i = 0; i < 6; ++i) before_[i] = piece_[i] / count_;
    begin_piece();
  }

  void landed() noexcept {
    const int whole = pieces_ - 2;
    if (whole > 0) {
      swings_ = std::min(swings_ + 1, SWINGS_REMEMBERED);
      for (int i = 0; i < 6; ++i) zero_[i] += (sum_[i] / whole - zero_[i]) / swings_;
    }
    sum_ = {}, pieces_ = 0;
    begin_piece();
  }

 private:
  void begin_piece() noexcept { piece_ = {}, count_ = 0, time_ = 0.0; }

  Wrench zero_ = {}, sum_ = {}, before_ = {}, piece_ = {};
  double least_ = 0.0, most_ = 0.0, time_ = 0.0;
  int count_ = 0, pieces_ = 0, swings_ = 0;
};

}  // namespace plantar
