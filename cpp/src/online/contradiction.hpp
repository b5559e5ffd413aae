// Sensors that contradict each other: a gyroscope and an attitude that turn differently, feet that do not carry the
// robot. None of them says which is wrong; nothing is learnt from either.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "online/one_pole.hpp"
#include "online/white_noise.hpp"

namespace plantar {

constexpr double TURN_BAND = 1.5;      // Hz: of the turns that are compared; an attitude's noise is smaller there
constexpr double TURN_TIME = 0.5;      // s over which they are compared
constexpr double TURN_SHARE = 0.3;     // of that time, in which they differ: between two swings neither turns
constexpr double MOST_SHARE = 0.7;     // that is remembered: a fault of minutes is over as soon as one of a second
constexpr double LEAST_TURN = 0.005;   // rad/s: less spoils no damping
constexpr double TURN_NOISE = 4.0;     // deviations of what the attitude's noise makes of it
constexpr double TURNS_DIFFER = 0.5;   // of the larger of both: no gain and no filter makes that
constexpr double TURNS_SURE = 1.8;     // times that, at once: 0.9 of the larger of both
constexpr double LEAST_SURE = 0.03;    // rad/s
constexpr double FASTEST_TURN = 1.5;   // rad/s: no chest over standing feet turns faster; larger readings echo no longer
constexpr double ZERO_TIME = 20.0;     // s in which a gyroscope's zero is learnt, and a usual load
constexpr double SEEN_TURN = 2.0;      // times the attitude's noise, mean squares over that time: a turn that is small
constexpr double TOGETHER_TIME = 2.0;  // s without which nothing is said of it
constexpr double ZERO_NEWS = 0.02;     // rad/s: the most that one reading says of it
constexpr double LOAD_TIME = 0.4;      // s over which the feet's load is compared: a step's accelerations cancel
constexpr double LOAD_DIFFERS = 0.15;  // of the weight: a step's rest is less
constexpr double WRONG_MASS = 0.2;     // of the weight: gains and a mass that is not the model's
constexpr double LOAD_ZERO = 0.15;     // of the weight, of each foot that has not swung yet

// The turning of the vertical, as attitude and gyroscope tell it: yaw is of no account.
class TurnWatch {
 public:
  using Vector = std::array<double, 3>;

  void restart() noexcept {
    known_ = false, share_ = 0.0, filtered_ = {}, followed_ = {};
    for (WhiteNoise& noise : noise_) noise.restart();
  }

  // up: the vertical in the IMU's frame; rate: mean of the last two readings [rad/s].
  bool differ(const Vector& up, const double* rate, double dt) noexcept {
    const Vector before = up_;
    up_ = up;
    double variance = 0.0;
    for (int i = 0; i < 3; ++i) {
      noise_[i].see(up[i], dt);
      variance += noise_[i].variance();
    }
    if (!known_) {
      known_ = true;
      return false;
    }
    const Vector middle = {0.5 * (up[0] + before[0]), 0.5 * (up[1] + before[1]), 0.5 * (up[2] + before[2])};
    const Vector by_rate = {middle[1] * rate[2] - middle[2] * rate[1], middle[2] * rate[0] - middle[0] * rate[2],
                            middle[0] * rate[1] - middle[1] * rate[0]};
    age_ += dt;
    const double edge = 2.0 * std::numbers::pi * TURN_BAND, pass = followed_after(edge * dt);
    const double learnt = std::max(followed_after(dt / ZERO_TIME), dt / age_);
    const double ticks = 1.0 / dt;  // in a second
    double attitude = 0.0, gyroscope = 0.0, between = 0.0, without_zero = 0.0, common = 0.0;  // squares
    for (int i = 0; i < 3; ++i) {
      const double told[2] = {(up[i] - before[i]) * ticks, by_rate[i]};
      for (int a = 0; a < 2; ++a)
        filtered_[a][i] += pass * (std::clamp(told[a], -FASTEST_TURN, FASTEST_TURN) - filtered_[a][i]);
      const double differs = filtered_[0][i] - filtered_[1][i] - zero_[i];
      zero_[i] += learnt * std::clamp(differs, -ZERO_NEWS, ZERO_NEWS);
      attitude += filtered_[0][i] * filtered_[0][i], gyroscope += filtered_[1][i] * filtered_[1][i];
      between += differs * differs;
      const double turns = filtered_[1][i] + zero_[i];
      without_zero += turns * turns, common += turns * filtered_[0][i];
    }
    const double white = edge * edge * variance, noise = TURN_NOISE * TURN_NOISE * white;
    const double turns = TURNS_DIFFER * TURNS_DIFFER * std::max(attitude, gyroscope);
    const double likely = std::max({LEAST_TURN * LEAST_TURN, noise, turns});
    if (between <= likely) followed_.see(attitude - white, without_zero, common, dt);
    share_ = std::min(share_ + followed_after(dt / TURN_TIME) * ((between > likely) - share_), MOST_SHARE);
    return share_ > TURN_SHARE || followed_.apart(white) ||
           between > TURNS_SURE * TURNS_SURE * std::max(likely, LEAST_SURE * LEAST_SURE);
  }

 private:
  // Mean squares of both turns, and of what they have in common, over ZERO_TIME: turns that are too small to say
  // anything at once add up; those that do are told anyway.
  struct Followed {
    double age = 0.0, attitude = 0.0, gyroscope = 0.0, common = 0.0;

    void see(double by_attitude, double by_gyroscope, double both, double dt) noexcept {
      age += dt;
      const double news = std::max(followed_after(dt / ZERO_TIME), dt / age);
      attitude += news * (by_attitude - attitude), gyroscope += news * (by_gyroscope - gyroscope);
      common += news * (both - common);
    }
    bool apart(double white) const noexcept {
      const double larger = std::max(attitude, gyroscope);
      return age > TOGETHER_TIME && larger > SEEN_TURN * white && common < TURNS_DIFFER * larger;
    }
  };

  bool known_ = false;
  Followed followed_;
  double age_ = 0.0, share_ = 0.0;
  Vector up_ = {}, zero_ = {};
  std::array<Vector, 2> filtered_ = {};  // what attitude and gyroscope tell
  std::array<WhiteNoise, 3> noise_;
};

// Whether the feet carry the robot's weight, while one of them stands. A wrong mass and the sensors' gains make what
// they usually carry.
class WeightWatch {
 public:
  explicit WeightWatch(double weight) noexcept : weight_(weight) {}

  void restart() noexcept { mean_ = usual_; }

  // total: what all feet carry [N]; unknown: of how many of them no swing has shown the zero.
  bool differs(double total, int unknown, double dt) noexcept {
    mean_ += followed_after(dt / LOAD_TIME) * (total - mean_);
    if (std::abs(mean_ - usual_) > (LOAD_DIFFERS + LOAD_ZERO * unknown) * weight_) return true;
    if (unknown > 0) return false;
    usual_ += followed_after(dt / ZERO_TIME) * (mean_ - usual_);
    usual_ = std::clamp(usual_, (1.0 - WRONG_MASS) * weight_, (1.0 + WRONG_MASS) * weight_);
    return false;
  }

 private:
  double weight_, usual_ = weight_, mean_ = weight_;
};

}  // namespace plantar
