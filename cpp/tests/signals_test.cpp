// What signals pass before anything is learnt from them: attitude without one, low-pass, smooth angle, delay, noise.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "check.hpp"
#include "online/attitude_filter.hpp"
#include "online/causal_filter.hpp"
#include "online/delay_line.hpp"
#include "online/smooth_angle.hpp"
#include "online/white_noise.hpp"

namespace signals_test {

using namespace plantar;

constexpr double PI = std::numbers::pi;
using Quaternion = AttitudeFilter::Quaternion;
using Vector = std::array<double, 3>;

Quaternion times(const Quaternion& p, const Quaternion& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}
// The world's up in the frame of an IMU whose attitude this is.
Vector up(const Quaternion& q) {
  const Quaternion back = {q[0], -q[1], -q[2], -q[3]}, turned = times(times(back, {0.0, 0.0, 0.0, 1.0}), q);
  return {turned[1], turned[2], turned[3]};
}
double apart(const Vector& a, const Vector& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

void an_attitude_begins_with_up_where_the_accelerometer_reads_it() {
  constexpr double STILL[3] = {0.0, 0.0, 0.0};
  for (const Vector& a : {Vector{0.6, 0.0, 0.8}, Vector{0.48, -0.6, 0.64}, Vector{0.0, 0.6, -0.8}, Vector{0.0, 0.0, -1.0}}) {
    AttitudeFilter filter;
    const double read[3] = {9.81 * a[0], 9.81 * a[1], 9.81 * a[2]}, none[3] = {};
    check::that(apart(up(filter.step(STILL, read, 0.01)), a) < 1e-9, "the first reading is up");
    check::that(apart(up(filter.step(STILL, none, 0.01)), a) < 1e-9, "no reading, no news");
    filter.restart();
    const double level[3] = {0.0, 0.0, 9.81};
    check::that(apart(up(filter.step(STILL, level, 0.01)), {0.0, 0.0, 1.0}) < 1e-9, "begun anew, the next one is");
  }
}

// An even turn about any axis of the IMU, with an accelerometer that agrees with what was known before each tick.
void an_attitude_goes_on_by_the_gyroscope() {
  constexpr double DT = 0.01;
  for (const Vector& rate : {Vector{0.3, -0.5, 0.7}, Vector{-1.0, 0.2, 0.0}, Vector{0.0, 0.4, -0.9}}) {
    AttitudeFilter filter;
    const double still[3] = {}, first[3] = {1.0, 2.0, 9.0};
    const Quaternion begins = filter.step(still, first, DT);
    const double speed = std::hypot(rate[0], rate[1], rate[2]);
    Quaternion wanted = begins;
    for (int tick = 1; tick < 300; ++tick) {
      const double half = 0.5 * speed * tick * DT, s = std::sin(half) / speed;
      const Quaternion found = filter.step(rate.data(), up(wanted).data(), DT);
      wanted = times(begins, {std::cos(half), s * rate[0], s * rate[1], s * rate[2]});
      double dot = 0.0;
      for (int i = 0; i < 4; ++i) dot += found[i] * wanted[i];
      check::that(std::abs(dot) > 1.0 - 1e-12 && apart(up(found), up(wanted)) < 1e-9, "an even turn");
    }
  }
}

// The second reading behind a pause counts as much as the first one, however long was read before.
void an_attitude_begun_anew_is_a_mean_of_few() {
  constexpr double STILL[3] = {}, LEVEL[3] = {0.0, 0.0, 9.81}, TILTED[3] = {0.098, 0.0, 9.81};
  AttitudeFilter filter;
  for (int tick = 0; tick < 6000; ++tick) filter.step(STILL, LEVEL, 0.01);
  filter.restart();
  filter.step(STILL, TILTED, 0.01);
  check::near(up(filter.step(STILL, LEVEL, 0.01))[0], 0.0, 1e-4, "turned onto it at once");
}

// Tilts of a reading come in with the blend's time constant, at first as the mean of all readings.
void an_accelerometer_tells_up_slowly() {
  constexpr double DT = 0.01, TILT = 0.01;
  for (const int axis : {0, 1})
    for (const double level : {0.5, 60.0}) {
      AttitudeFilter filter;
      const double still[3] = {};
      double time = 0.0;
      const auto reads = [&](double tilt, double seconds) {
        Quaternion q = {};
        for (const double ends = time + seconds; time < ends - 1e-9; time += DT) {
          double read[3] = {0.0, 0.0, 9.81 * std::cos(tilt)};
          read[axis] = 9.81 * std::sin(tilt);
          q = filter.step(still, read, DT);
        }
        return up(q);
      };
      reads(0.0, level);
      const double found = reads(TILT, level == 0.5 ? 0.5 : 5.0)[axis];
      const double wanted = level == 0.5 ? 0.5 : 1.0 - std::exp(-2.0 * PI * 0.03 * 5.0);
      check::near(found, wanted * TILT, 0.02 * TILT, "a tilt of the accelerometer");
    }
}

// Butterworth's of fourth order, bilinear: a half of the power at the cutoff, and eight powers of the frequency's tangent.
void a_low_pass_is_butterworths() {
  constexpr double CUTOFF = 5.0, PERIOD = 0.005;
  for (const double frequency : {0.0, 2.5, 5.0, 8.0}) {
    CausalFilter<2> filter;
    filter.design(CUTOFF, PERIOD);
    double first = 0.0, square = 0.0;
    constexpr int SETTLED = 400, SAMPLES = 400;
    for (int run = 0; run < 2; ++run) {
      square = 0.0;
      for (int i = 0; i < SETTLED + SAMPLES; ++i) {
        const double x = std::cos(2.0 * PI * frequency * PERIOD * i + 0.3);
        double values[2] = {x, -3.0 * x};
        filter.pass(values);
        check::near(values[1], -3.0 * values[0], 1e-12, "all channels alike");
        if (i == 3) check::that(run == 0 || values[0] == first, "begun anew");
        if (i == 3) first = values[0];
        if (i >= SETTLED) square += values[0] * values[0] / SAMPLES;
      }
      filter.restart();
    }
    const double ratio = std::tan(PI * frequency * PERIOD) / std::tan(PI * CUTOFF * PERIOD);
    const double wanted = 1.0 / (1.0 + std::pow(ratio, 8)) * (frequency > 0.0 ? 0.5 : std::pow(std::cos(0.3), 2));
    check::near(square, wanted, 1e-3 * wanted, "power that passes");
  }
  CausalFilter<1> none;
  none.design(100.0, 0.0046);
  double values[1] = {0.7};
  none.pass(values);
  check::that(values[0] == 0.7, "a cutoff near half of the sampling rate filters nothing");
}

void a_smooth_angle_takes_what_is_quick_from_the_rate() {
  constexpr double DT = 0.001, USUAL = 2.5, BAND = 2.0 * PI * USUAL;
  SmoothAngle step, slope, begins;
  step.pass(0.0, 0.0, DT), slope.pass(0.0, 1.0, DT);
  double angle = 0.0, leads = 0.0;
  for (int i = 0; i < 50; ++i) angle = step.pass(1.0, 0.0, DT);
  check::near(angle, 1.0 - std::exp(-BAND * 50 * DT), 1e-9, "a step of the angle alone comes by its band");
  for (int i = 0; i < 2000; ++i) leads = slope.pass(0.0, 1.0, DT);
  check::near(leads, 1.0 / BAND, 0.01 / BAND, "a rate alone leads by the band's time");
  begins.pass(0.2, 0.0, DT);
  const double both = begins.pass(0.2, 1.0, DT);
  check::near(both - 0.2, 0.5 * DT * std::exp(-BAND * DT), 1e-12, "by the mean of both rates");
  begins.restart();
  check::that(begins.pass(0.7, 5.0, DT) == 0.7, "begun anew");
  // Shares of white noise that go with the noise itself, in the mean up to the cutoff.
  for (const double cutoff : {1.0, 5.0}) {
    double share = 0.0;
    for (int i = 0; i < 1000; ++i) share += 1e-3 / (1.0 + std::pow((i + 0.5) * 1e-3 * cutoff / USUAL, 2));
    check::near(smooth_share(cutoff), share, 1e-5, "of the angle");
    check::near(smooth_lag(cutoff), share / BAND, 1e-5, "and of the rate");
  }
}

void a_delay_line_reads_between_its_samples() {
  DelayLine<2> line;
  DelayLine<2>::Values late;
  double time = 0.0;
  for (int i = 0; i < 1500; ++i) {
    time += i % 3 ? 0.002 : 0.003;
    const DelayLine<2>::Values now = {5.0 - 2.0 * time, time};
    const bool reaches = line.pass(time, now, 0.0123, late);
    check::that(reaches == (time - 0.0123 >= 0.003), "as far as it reaches back");
    if (reaches) check::near(late[0], 5.0 - 2.0 * (time - 0.0123), 1e-12, "a straight line");
    if (reaches) check::near(late[1], time - 0.0123, 1e-12, "each channel by itself");
  }
  check::that(line.pass(time + 0.002, {1.0, 2.0}, 0.0, late) && late[0] == 1.0, "no delay");
  check::that(line.pass(time + 0.004, {3.0, 2.0}, -0.5, late) && late[0] == 3.0, "nobody knows what comes");
  check::that(!line.pass(time + 0.006, {0.0, 0.0}, 2.0, late), "farther back than it holds");
  line.restart();
  check::that(!line.pass(time + 0.008, {0.0, 0.0}, 0.001, late), "begun anew, it holds nothing");
}

void white_noise_is_told_from_motion() {
  constexpr double DEVIATION = 3e-4, DT = 0.005;
  std::mt19937 random(4);
  std::normal_distribution<double> normal(0.0, DEVIATION);
  WhiteNoise noise, motion, jumps;
  double mean = 0.0;
  for (int i = 0; i < 8000; ++i) {
    const double moves = 0.05 * std::sin(6.0 * DT * i);
    noise.see(moves + normal(random), DT), motion.see(moves, DT);
    if (i >= 4000) mean += noise.variance() / 4000;
  }
  check::near(mean, DEVIATION * DEVIATION, 0.1 * DEVIATION * DEVIATION, "variance of noise");
  check::that(motion.variance() < 1e-4 * DEVIATION * DEVIATION, "motion has none");
  for (int i = 0; i < 20; ++i) jumps.see(0.0, DT);
  jumps.restart();
  for (int i = 0; i < 4; ++i) jumps.see(7.0, DT);
  check::that(jumps.variance() == 0.0, "begun anew, a jump is no noise");
}

void run() {
  an_attitude_begun_anew_is_a_mean_of_few();
  an_attitude_begins_with_up_where_the_accelerometer_reads_it();
  an_attitude_goes_on_by_the_gyroscope();
  an_accelerometer_tells_up_slowly();
  a_low_pass_is_butterworths();
  a_smooth_angle_takes_what_is_quick_from_the_rate();
  a_delay_line_reads_between_its_samples();
  white_noise_is_told_from_motion();
}

const check::Listed listed(run);

}  // namespace signals_test
