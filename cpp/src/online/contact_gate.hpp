// Whether a foot stands, from its vertical force: causal, with a hysteresis, and settled before it counts.
#pragma once

#include <algorithm>

#include "online/one_pole.hpp"
#include "plantar/foot_estimator.hpp"

namespace plantar {

constexpr double LANDING_SHARE = 0.10;  // of the weight: a foot that carries more stands
constexpr double LIFTING_SHARE = 0.05;  // of the weight: a foot that carries less is in the air
constexpr double FORCE_BAND = 40.0;     // Hz, of the force that decides: 4 ms late
constexpr double SETTLING_TIME = 0.25;  // s behind a landing and before a lift, at most
constexpr double SETTLING_SHARE = 0.1;  // of a usual stance, at most
constexpr double FIRST_STANCE = 2.5;    // s: a usual stance before any was seen
constexpr double NEWS = 0.3;            // by how much one stance changes what is usual
constexpr double LIGHT = 0.2;           // of the weight: a foot that reads no more may be in the air
constexpr double OTHERS_CARRY = 0.7;    // of the weight: then it is, whatever its zero
constexpr double LIGHT_TIME = 0.1;      // s for which it must read so

class ContactGate {
 public:
  ContactGate(double weight, bool always) noexcept : weight_(weight), always_(always) {}

  // load: vertical force [N], zero taken off; others: of the other feet; flat: whether the pressure is inside the sole.
  ContactState step(double load, double others, bool flat, bool zero_known, double dt) noexcept {
    if (always_) return contact_ = ContactState::stance;
    const double blend = first_ ? 1.0 : followed_in_band(FORCE_BAND, dt);
    smooth_ += blend * (load - smooth_);
    first_ = false;
    const bool light = !zero_known && smooth_ < LIGHT * weight_ && others > OTHERS_CARRY * weight_;
    light_ = light ? light_ + dt : 0.0;
    const bool lifted = smooth_ < LIFTING_SHARE * weight_ || light_ > LIGHT_TIME;
    if (contact_ == ContactState::air) {
      if (smooth_ > LANDING_SHARE * weight_ && !(light && light_ > 0.0)) contact_ = ContactState::landing, since_ = 0.0;
    } else if (lifted) {
      if (contact_ == ContactState::stance) {
        usual_ += NEWS * (since_ - usual_);
        ++stances_;
      }
      contact_ = ContactState::air, since_ = 0.0;
    } else if (contact_ == ContactState::landing && flat && since_ >= settling()) {
      contact_ = ContactState::stance;
    }
    since_ += dt;
    return contact_;
  }

  // Readings are missing: what is known of the contact may be old.
  void restart() noexcept {
    if (contact_ == ContactState::stance) contact_ = ContactState::landing, since_ = 0.0;
    first_ = true;
  }

  ContactState contact() const noexcept { return contact_; }
  double settling() const noexcept { return std::min(SETTLING_TIME, SETTLING_SHARE * usual_); }
  double standing_for() const noexcept { return contact_ == ContactState::air ? 0.0 : since_; }
  int stances() const noexcept { return stances_; }

 private:
  double weight_;
  bool always_, first_ = true;
  ContactState contact_ = ContactState::air;
  double smooth_ = 0.0, since_ = 0.0, usual_ = FIRST_STANCE, light_ = 0.0;
  int stances_ = 0;
};

}  // namespace plantar
