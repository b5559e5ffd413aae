// Sensors that say nothing: values that are not finite, and readings that stand still while their noise should not.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace plantar {

constexpr double LARGEST = 1e12;                       // in any unit: what no sensor reads
constexpr double FROZEN_TIME = 0.1;                    // s without any change: no device is read so rarely
constexpr int FROZEN_SAMPLES = 8;                      // and so many samples: a slow log repeats nothing that long
constexpr double NOISY_TIME = 10.0;                    // s, in which a noisy channel repeats itself
constexpr double NOISY_REPEATS = 0.01;                 // so rarely
constexpr double WHOLE_TURN = 2.0 * std::numbers::pi;  // rad: no joint of a leg turns further: those are degrees
constexpr double FROZEN_WAY = 0.01;  // rad or m that a joint's velocity says it moved while its position stood
constexpr double LEFT_BEHIND = 0.04;  // rad or m that others have moved meanwhile: beside REEM-C's good ones up to 0.02
constexpr double FROZEN_STEPS = 100.0;  // of its encoder's, by others: good ones that turned round have stood for 40
constexpr double BEYOND_USUAL = 2.0;    // times the longest way of others during which it has stood, and moved again
constexpr double TWIN_MOVED = 0.02;  // rad or m that the other leg's joint has moved, while this one never did by a bit
constexpr double LEAST_WAY = 0.002;  // rad or m: less is noise of an encoder, and so are
constexpr double FLICKER = 3.0;      // steps of it
constexpr double LEAP = 4.0;         // times the way of the next tick: a joint that sets out does not stop again at once

inline bool all_finite(std::span<const double> values) noexcept {
  for (const double value : values)
    if (!(std::abs(value) < LARGEST)) return false;
  return true;
}

// How long a channel has read the same, and how rarely it usually does.
class RepeatWatch {
 public:
  // Whether it is stuck.
  bool see(double value, double dt) noexcept {
    const bool same = value == last_;
    if (!same) usually_ = repeats_;
    last_ = value;
    time_ = same ? time_ + dt : 0.0, samples_ = same ? samples_ + 1 : 0;
    stuck_ = time_ > FROZEN_TIME && samples_ >= FROZEN_SAMPLES;
    if (stuck_) return true;
    seen_ += dt;
    const double news = seen_ > NOISY_TIME ? std::min(dt * (1.0 / NOISY_TIME), 1.0) : dt / std::max(seen_, 1e-9);
    repeats_ += news * (same - repeats_);
    return false;
  }

  bool stuck() const noexcept { return stuck_; }
  bool changed() const noexcept { return samples_ == 0; }
  bool noisy() const noexcept { return seen_ > NOISY_TIME && usually_ < NOISY_REPEATS; }

 private:
  double last_ = 0.0, time_ = 0.0;
  int samples_ = 0;
  bool stuck_ = false;
  double seen_ = 0.0, repeats_ = 0.0;  // s in which it was not stuck; the share of readings that repeat the last one
  double usually_ = 0.0;               // the same, before it read the same last
};

// Noisy readings of one device: one that repeats all of them is frozen; so is a channel that repeats itself and has
// hardly ever done so before, but for zeros: a simulated foot in the air reads them.
template <int SIZE>
class DeviceWatch {
 public:
  bool frozen(std::span<const double> values, double dt) noexcept {
    bool all = true, one = false;
    for (int i = 0; i < SIZE; ++i) {
      const bool stuck = channels_[i].see(values[i], dt);
      all = all && stuck;
      one = one || (stuck && values[i] != 0.0 && channels_[i].noisy());
    }
    return all || one;
  }

 private:
  RepeatWatch channels_[SIZE];
};

// An encoder may well repeat itself at rest: it is frozen where its velocity says that the joint moved, where it has
// not changed by a bit since the first tick and the same joint of another leg has moved, where its noise is gone and
// that of the same joint of another leg is not, or where it stands by a bit while the same joint of another leg and
// others of its own leg go farther than they ever did meanwhile: one leg may well stand while the other moves.
class JointWatch {
 public:
  // Time begins anew, perhaps elsewhere. Nobody mends an encoder in between: one that was dead is, until it moves.
  void restart() noexcept { way_ = passed_ = leap_ = 0.0, begun_ = leapt_ = false; }

  bool frozen(double position, double velocity, double dt) noexcept {
    const bool stood = repeats_.stuck();
    repeats_.see(position, dt);
    const double went = begun_ ? std::abs(position - last_) : 0.0;
    leapt_ = leap_ > std::max(LEAST_WAY, FLICKER * step_) && went < leap_ / LEAP;
    leap_ = stood ? went : 0.0;
    if (begun_ && position != last_) step_ = std::min(step_, std::abs(position - last_));
    way_ = begun_ && position == last_ ? way_ + std::abs(velocity) * dt : 0.0;
    if (begun_ && position != last_) dead_ = false;
    last_ = position;
    low_ = begun_ ? std::min(low_, position) : position, high_ = begun_ ? std::max(high_, position) : position;
    const double gone = begun_ ? std::abs(position - corner_) : 0.0;
    if (!begun_ || gone > std::max(LEAST_WAY, FLICKER * step_)) corner_ = position, moved_ += gone;
    begun_ = true;
    return way_ > FROZEN_WAY;
  }
  // Whether it has never moved, although its twin has.
  bool dead(const JointWatch& twin) noexcept {
    dead_ = dead_ || (begun_ && high_ == low_ && twin.begun_ && twin.high_ - twin.low_ > TWIN_MOVED);
    return dead_;
  }
  // Whether it stands where it should not. leg: the way of the joints of its leg [rad or m].
  bool stuck(const JointWatch& twin, double leg) noexcept {
    const auto limit = [&](double least) { return std::max({least, FROZEN_STEPS * step_, BEYOND_USUAL * usual_}); };
    if (repeats_.changed()) {
      if (passed_ > 0.0 && passed_ <= limit(LEFT_BEHIND)) usual_ = std::max(usual_, passed_);
      twin_then_ = twin.moved_, leg_then_ = leg, passed_ = 0.0;
    }
    doubtful_ = repeats_.stuck() && twin.moved_ - twin_then_ > limit(LEAST_WAY);
    if (!repeats_.stuck()) return false;
    silent_ = silent_ || twin.repeats_.stuck();
    passed_ = std::min(twin.moved_ - twin_then_, leg - leg_then_);
    return passed_ > limit(LEFT_BEHIND) || (!silent_ && repeats_.noisy() && twin.repeats_.noisy());
  }
  // Whether it stands while its twin moves twice as far as it ever did before this one moved again: nothing may be
  // wrong, but nothing is learnt from it.
  bool doubtful() const noexcept { return doubtful_; }
  // Whether it has gone far at the last tick, at once from where it stood, and hardly on since: it had been frozen.
  bool leapt() const noexcept { return leapt_; }
  // Its way since the first tick, without its noise [rad or m].
  double moved() const noexcept { return moved_; }

 private:
  RepeatWatch repeats_;
  double last_ = 0.0, way_ = 0.0, low_ = 0.0, high_ = 0.0, corner_ = 0.0, moved_ = 0.0;
  double step_ = LARGEST;                    // the smallest change: an encoder's step, or noise
  double twin_then_ = 0.0, leg_then_ = 0.0;  // their ways when this one stood still first
  double passed_ = 0.0, usual_ = 0.0;        // by how much they have moved since; at most, where it moved again
  double leap_ = 0.0;                        // of the last tick, where it stood before
  bool begun_ = false, dead_ = false, doubtful_ = false, leapt_ = false;
  bool silent_ = false;  // it has stood beside its twin without any noise
};

}  // namespace plantar
