// Whether the stiffness has jumped: from firm ground onto mats, or back.
//
// Each probe, a part of a second of rows with an offset of its own, says how far the stiffness is from what was learnt.
// Its usual scatter beyond its own noise is followed, so that steps that differ anyway raise no alarm, and a clear
// probe counts for what it is after many unclear ones. Evidence for a large change is added up for either direction,
// and taken off again by probes that speak against it (CUSUM; E. S. Page, Biometrika 41, 1954). Probes that speak for a
// change are no usual scatter until others have spoken against it: the first one of a change shall not hide the second.
//
// A torque that comes late is no other stiffness: each probe lets it be later than was told, by what it changes in that
// time. Other ground may have another damping, too; that alone explains no delay, since a late torque lacks part of the
// damper's as well. Nor is it other ground where no line through deflection and rate explains a torque, or where one
// pulls the other way: no ground does that, a sensor does. There no delay is looked for: it would excuse too much. Nor
// is one believed that makes other ground of what in time is none: what speaks for a change must do so both ways.
#pragma once

#include <algorithm>
#include <cmath>

#include "online/root_triangle.hpp"

namespace plantar {

constexpr double PROBE_TIME = 0.75;      // s of rows: a usual stance
constexpr double WARY_TIME = 0.25;       // s of rows behind one that no ground makes, until a probe is clear again
constexpr int PROBE_ROWS = 8;            // as of a block; fewer say nothing
constexpr double CHANGE = 0.4;           // of the stiffness: half of it and less the regression follows by itself
constexpr double SURE_OF_CHANGE = 15.0;  // log-likelihood: three million to one
constexpr double MOST_OF_ONE = 7.5;      // of one probe: a single one may be a stumble
constexpr double SHOWS = 0.15;           // deviation over stiffness, beyond which a probe shows nothing
constexpr double UNTOLD_DELAY = 0.03;    // s: deviation of how late torques may be beyond what was told, in one probe
constexpr double OTHER_DAMPING = 0.05;   // s, times the stiffness: deviation of how much the damping may have changed
constexpr double UNEXPLAINED = 10.0;     // times a row's usual noise: what is left is no noise
constexpr double SURELY = 2.0;           // deviations
constexpr double BEYOND_DOUBT = 6.0;     // deviations, of a probe that shows little: there are many
constexpr double ROWS_ALIKE = 8.0;       // rows in a cycle of the filter: so many say the same
constexpr double FIRST_SCATTER = 0.1;    // of the stiffness, before any probe
constexpr double SCATTER_NEWS = 0.05;    // by how much one probe changes the usual scatter
constexpr double ODD = 9.0;              // squares of the scatter: what is farther is no usual scatter

class ChangeWatch {
 public:
  enum class Verdict { usual, changed, impossible };

  void restart() noexcept { *this = {}; }

  // A row: what the filter has made of a constant, the deflection's rate, what a torque lacks for each second that it
  // is late, the deflection, what an element's torque may be off by, and what the model leaves of the torque.
  void add(double one, double rate, double late, double deflection, double unknown, double left, double dt) noexcept {
    double plain[] = {one, rate, deflection, unknown, left}, delayed[] = {late, one, rate, deflection, unknown, left};
    in_time_.add(plain), delayed_.add(delayed);
    ++rows_, time_ += dt;
  }
  void forget() noexcept {
    if (rows_ > 0) drop();
    softer_ = stiffer_ = suspected_ = 0.0, probes_ = 0;
  }
  // Nothing speaks for a change, and no probe has begun.
  bool calm() const noexcept { return rows_ == 0 && softer_ == 0.0 && stiffer_ == 0.0; }
  // What speaks for a change to either side [log-likelihood].
  double softer() const noexcept { return softer_; }
  double stiffer() const noexcept { return stiffer_; }
  bool full() const noexcept { return time_ >= (wary_ ? WARY_TIME : PROBE_TIME); }
  // Whether the last probe was none that any ground makes.
  bool doubted() const noexcept { return doubted_; }
  void believe() noexcept { doubted_ = false; }
  void drop() noexcept { in_time_ = {}, delayed_ = {}, rows_ = 0, time_ = 0.0; }

  // Ends a probe: has the stiffness changed from what was learnt, with its deviation? noise: of a row [N·m].
  Verdict judge(double stiffness, double deviation, double noise) noexcept {
    const double damped = stiffness > 0.0 ? noise / (OTHER_DAMPING * stiffness) : 0.0;
    double line[] = {0.0, damped, 0.0, 0.0, 0.0}, its[] = {0.0, 0.0, damped, 0.0, 0.0, 0.0};
    double late[] = {noise / UNTOLD_DELAY, 0.0, 0.0, 0.0, 0.0, 0.0};
    in_time_.add(line), delayed_.add(its), delayed_.add(late);
    const Finding plain = found(in_time_, stiffness, noise), other = found(delayed_, stiffness, noise);
    drop();
    doubted_ = plain.left > std::max(UNEXPLAINED * noise, SHOWS * plain.shown) ||
               plain.away + (plain.own < SHOWS ? SURELY : BEYOND_DOUBT) * plain.own < -1.0;
    wary_ = doubted_ || (wary_ && plain.own > SHOWS);
    if (doubted_) return Verdict::impossible;
    if (std::max(plain.own, other.own) > SHOWS) return Verdict::usual;
    const double known = deviation / stiffness;
    const auto evidence = [&](double change) {
      double least = MOST_OF_ONE;
      for (const Finding& one : {plain, other}) {
        const double variance = scatter_ + one.own * one.own + known * known;
        least = std::min(least, change * (one.away - 0.5 * change) / variance);
      }
      return std::max(least, -MOST_OF_ONE);
    };
    softer_ = std::max(0.0, softer_ + evidence(-CHANGE));
    stiffer_ = std::max(0.0, stiffer_ + evidence(CHANGE));
    const double square = plain.away * plain.away, own = plain.own * plain.own;
    const double beyond = std::clamp(square - own, 0.0, ODD * (scatter_ + own));
    suspected_ += beyond, ++probes_;
    for (; calm() && probes_ > 0; --probes_) {
      const double mean = suspected_ / probes_;
      scatter_ += SCATTER_NEWS * (mean - scatter_), suspected_ -= mean;
    }
    return std::max(softer_, stiffer_) < SURE_OF_CHANGE ? Verdict::usual : Verdict::changed;
  }

 private:
  // What one probe says: how far the stiffness is from what was learnt, and its deviation, both as shares of it; what
  // is left of a row, and the torque that the deflection makes as nothing else does [N·m].
  struct Finding {
    double away = 0.0, own = 1.0, left = 0.0, shown = 0.0;
  };

  // The last two of N unknowns are the deflection and an element's torque.
  template <int N>
  Finding found(const RootTriangle<N>& probe, double stiffness, double noise) const noexcept {
    const auto& deflection = probe.r[N - 2];
    const double shown = deflection[N - 2] * stiffness;
    if (rows_ < PROBE_ROWS || !(shown > 0.0)) return {};
    const double left = probe.r[N][N] * std::sqrt(ROWS_ALIKE / rows_);
    return {deflection[N] / shown, std::hypot(std::max(noise, left), deflection[N - 1]) / shown, left, shown};
  }

  RootTriangle<4> in_time_;  // as if torques came when it was told
  RootTriangle<5> delayed_;  // or later
  bool doubted_ = false, wary_ = false;
  int rows_ = 0, probes_ = 0;  // since nothing was suspected
  double suspected_ = 0.0;     // sum of what these were off beyond their noise
  double time_ = 0.0, softer_ = 0.0, stiffer_ = 0.0, scatter_ = FIRST_SCATTER * FIRST_SCATTER;
};

}  // namespace plantar
