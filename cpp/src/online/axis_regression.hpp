// Stiffness and damping of one axis: least squares in square-root form over stances, each with an offset of its own.
//
// Rows of one stance (of some seconds of it, where the robot stands) are gathered with an offset, which is then
// eliminated. What is left joins one of some groups of consecutive data; leaving out one group after the other says how
// far the values can be trusted, however the errors within a group hang together (delete-group jackknife).
//
// Noise of angles and rates adds to their squares but to no product with the torque, and so draws the values to zero:
// its expected share is taken off again (W. A. Fuller, Measurement Error Models, Wiley 1987).
#pragma once

#include <array>

#include "online/change_watch.hpp"
#include "online/root_triangle.hpp"

namespace plantar {

// Columns of a row beside the offset's: what each unknown multiplies.
enum Unknown : int { STIFFNESS, DAMPING, SLIP_TORQUE, ASIDE, ABOVE };
constexpr int UNKNOWNS = 5;

// Where noise enters: the deflection alone, the rate, or the deflection and with it an element that does not slip.
enum NoiseSource : int { OF_ANGLE, OF_RATE, OF_ANGLE_AND_ELEMENT };
constexpr int NOISE_SOURCES = 3;

constexpr int MOST_GROUPS = 12;
constexpr int FEWEST_GROUPS = 3;       // that say how they differ
constexpr double FIRST_GROUP = 1.0;    // s of rows in one group, in the beginning
constexpr double LARGEST_GROUP = 8.0;  // s: errors hang together for less
constexpr double MEMORY = 2.0;         // fillings of each group that are remembered
constexpr double BLOCK = 2.5;          // groups with one offset, of a foot that stands: the attitude drifts more slowly
constexpr double LONGEST_BLOCK = 10.0;  // s
constexpr int FEWEST_ROWS = 8;          // of a block: with fewer its offset takes most of it

struct RegressionRow {
  double one;  // what the filter has made of a constant
  double columns[UNKNOWNS];
  double torque;
  double noise[NOISE_SOURCES];  // variance, of each source
};

struct RegressionPrior {
  std::array<double, UNKNOWNS> scale;  // a usual size of each column
  std::array<double, UNKNOWNS> mean;   // of each unknown, before any data, and how far it may be off
  std::array<double, UNKNOWNS> spread;
  double element_slope;  // of the element's state over the deflection, where it does not slip [1/rad]
};

struct AxisValues {
  std::array<double, UNKNOWNS> value = {};
  std::array<double, UNKNOWNS> std = {};  // of the rows' errors and of the prior
  double offset = 0.0;
  double pace = 0.0;  // squares of the rate over those of the deflection [1/s²]
  int groups = 0;
};

class AxisRegression {
 public:
  explicit AxisRegression(const RegressionPrior& prior) noexcept;

  // One row of the stance that is open, standing for `dt` seconds.
  void add(const RegressionRow& row, double dt) noexcept;
  // The stance ends, or one begins elsewhere.
  void close() noexcept;
  // Forgets everything that was learnt.
  void restart() noexcept;
  // Whether the stiffness has jumped since this was asked last; then everything before is forgotten.
  bool jumped() noexcept;
  void set_spread(Unknown unknown, double spread) noexcept { prior_.spread[unknown] = spread; }

  // One piece of the work that keeps `values` current, each short enough for one tick.
  void work() noexcept;
  const AxisValues& values() const noexcept { return values_; }

 private:
  using Shared = RootTriangle<UNKNOWNS>;
  struct Part {
    Shared triangle;
    double noise[NOISE_SOURCES] = {};
    double rows = 0.0;
    void add(const Part& other) noexcept;
  };
  struct Group : Part {
    double time = 0.0;
  };

  Part open_part() const noexcept;
  void take(const Part& part) noexcept;
  void merge_pairs() noexcept;
  void sum_up() noexcept;
  // With the prior, without the noise: the triangle that the values are solved from.
  Shared completed(const Part& data) const noexcept;
  std::array<double, UNKNOWNS> direction(int source) const noexcept;
  void solve() noexcept;
  void find_deviations() noexcept;
  void watch(const RegressionRow& row, double dt) noexcept;

  RegressionPrior prior_;
  RootTriangle<UNKNOWNS + 1> open_;  // the offset first
  int open_rows_ = 0;
  double open_time_ = 0.0, open_noise_[NOISE_SOURCES] = {};
  std::array<Group, MOST_GROUPS> groups_;
  int used_ = 0, current_ = 0;
  bool full_ = false;
  double group_time_ = FIRST_GROUP;
  Part total_;
  double noise_ = 0.0;  // of a row, as much as rows that hang together leave [N·m]
  bool changed_ = false, unsure_ = false, fresh_ = false;
  bool jumped_ = false;
  ChangeWatch watch_;
  AxisValues values_;
};

}  // namespace plantar
