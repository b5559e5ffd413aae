// From the signals of a foot's ticks to rows of its regressions: one filter for all of them, rows that wait until the
// foot has not lifted behind them.
#include <algorithm>
#include <cmath>

#include "online/foot_tracker.hpp"

namespace plantar {

namespace {

constexpr double ROWS_PER_CYCLE = 8.0;  // of the cutoff: more say the same

}  // namespace

void FootTracker::restart_filter() noexcept {
  running_ = false;
  row_ticks_ = 0, row_time_ = 0.0;
}

// Signals in the middle of a tick's period, each as late as the latest of them. A difference is the mean of a rate over the
// period; the mean of both its ends, as of all else, is more than that by a twelfth of the rate's second difference. That
// takes the next tick, too.
void FootTracker::filter(const FootKinematics& motion, double time, double dt, double period) noexcept {
  const std::array<double, 7> now = {estimate_.load,        wrench_[0], wrench_[1], estimate_.pitch.torque,
                                     estimate_.roll.torque, bends_[0],  bends_[1]};
  const bool stands = estimate_.contact == ContactState::stance;
  Middle next = {time, dt, stands, stands && (estimate_.flags & EDGE), flat_ && estimate_.contact == ContactState::landing};
  const double ticks = dt > 0.0 ? 1.0 / dt : 0.0;  // in a second
  for (int i = 0; i < 5; ++i) next.forces[i] = 0.5 * (now[i] + before_[i]);
  for (int a = 0; a < 2; ++a) {
    next.forces[5 + a] = (now[3 + a] - before_[3 + a]) * ticks;
    next.forces[7 + a] = 0.5 * (now[5 + a] + before_[5 + a]);
    next.forces[9 + a] = (now[5 + a] - before_[5 + a]) * ticks;
    next.angles[a] = motion.mean_angle[a], next.angles[2 + a] = motion.mean_rate[a];
    next.angles[6 + a] = 0.5 * (motion.turning[a] + turning_before_[a]);
    turning_before_[a] = motion.turning[a];
    next.of_ends[a] = motion.gyroscope ? next.angles[6 + a] : 0.0;
    next.difference[a] = motion.mean_rate[a] - next.of_ends[a];
  }
  before_ = now;
  Middle row = last_;
  for (int a = 0; a < 2; ++a) {
    const auto twelfth = [&](const double (Middle::*rate)[2]) {
      return ((next.*rate)[a] - 2.0 * (last_.*rate)[a] + (before_last_.*rate)[a]) * (1.0 / 12.0);
    };
    row.mean_rate[a] = row.angles[2 + a] - twelfth(&Middle::of_ends);
    row.angles[2 + a] += twelfth(&Middle::difference);
  }
  before_last_ = last_, last_ = next;
  middles_ = period > 0.0 ? std::min(middles_ + 1, 3) : 0;
  if (middles_ < 3) return;
  time = row.time, dt = row.dt;
  std::array<double, 8>& angles = row.angles;
  std::array<double, 11>& forces = row.forces;
  for (int a = 0; a < 2; ++a) angles[4 + a] = smooth_[a].pass(angles[a], row.mean_rate[a], dt);
  const bool reaches = angles_.pass(time, angles, delay_, angles) && forces_.pass(time, forces, -delay_, forces);
  if (!reaches) return;
  // By the torques of that time, which are as late as they were told to be.
  for (int a = 0; a < 2; ++a)
    angles[a] += forces[7 + a], angles[2 + a] += forces[9 + a], angles[4 + a] += forces[7 + a];
  follow_elements(row, time, dt);
  const bool paused = pause_ > 0.0;
  pause_ -= std::min(pause_, dt);
  if (!row.stands) return;
  if (left_out_ || (estimate_.flags & (SLIP | IMPACT | CONTRADICTION))) {
    pause_ = std::abs(delay_) + 1.5 * dt;  // two ticks, and the delay
    return;
  }
  // The delay lines and the mean over a period still hold what was left out.
  if (paused) return;
  if (!running_) {
    filter_.design(cutoff_, period);
    filter_.restart();
    running_ = true, begun_ = time;
  }
  const double load = forces[0], x = forces[1], y = forces[2];
  double channels[FilteredRow::CHANNELS] = {1.0,
                               time - begun_,
                               load,
                               x,
                               y,
                               load * x,
                               load * y,
                               std::sin(angles[0]),
                               angles[0],
                               angles[2],
                               angles[6],
                               element_[0].state(),
                               element_[0].gap(),
                               forces[3],
                               forces[5],
                               angles[1],
                               angles[3],
                               angles[7],
                               element_[1].state(),
                               element_[1].gap(),
                               forces[4],
                               forces[6]};
  filter_.pass(channels);
  row_time_ += dt;
  const int stride = std::max(1, static_cast<int>(1.0 / (ROWS_PER_CYCLE * cutoff_ * period)));
  if (++row_ticks_ < stride) return;
  hold(time, row_time_, channels);
  row_ticks_ = 0, row_time_ = 0.0;
}

void FootTracker::hold(double time, double dt, const double* channels) noexcept {
  if (held_count_ == HELD) {
    if (held_[first_held_].time <= inside_until_) give(held_[first_held_]);
    first_held_ = (first_held_ + 1) % HELD, --held_count_;
  }
  HeldRow& row = held_[(first_held_ + held_count_++) % HELD];
  row.time = time, row.dt = dt;
  std::copy_n(channels, FilteredRow::CHANNELS, row.signals.channels);
}

void FootTracker::commit(double before) noexcept {
  while (held_count_ > 0 && held_[first_held_].time <= before) {
    give(held_[first_held_]);
    first_held_ = (first_held_ + 1) % HELD, --held_count_;
  }
}

void FootTracker::give(const HeldRow& row) noexcept {
  for (int a = 0; a < 2; ++a) {
    const RegressionRow line = row.signals.of_axis(a, noise_);
    if (has_element(*foot_, a)) {
      axes_[a].add(line, row.dt);
    } else {
      memories_[a].add(line, row.dt);
      axes_[a].add(without_element(line), row.dt);
    }
  }
}

}  // namespace plantar
