// Stiffness and damping of one axis: least squares in square-root form over stances, each with an offset of its own.
//
// Rows of one stance (of some seconds of it, where the robot stands) are gathered with an offset and a drift of its
// own, which are then eliminated. What is left joins one of some groups of consecutive data; leaving out one group
// after the other says how far the values can be trusted, however the errors within a group hang together
// (delete-group jackknife).
//
// Noise of angles and rates adds to their squares but to no product with the torque, and so draws the values to zero;
// noise of forces also adds to their products with the torque about a bush that is not at the sensor. Both are
// measured, and their expected share is taken off again (W. A. Fuller, Measurement Error Models, Wiley 1987), but for
// what went with the offset and the others of each block.
#pragma once

#include <array>

#include "online/change_watch.hpp"
#include "online/root_triangle.hpp"

namespace plantar {

// Columns of a row beside the offset's: what each unknown multiplies. The bush's centre is ASIDE of and ABOVE its
// place, and higher the more it is loaded (COMPLIANCE). A torque that is later than was told lacks what it changes by
// in that time (LATE), a deflection what an IMU behind the encoders has yet to say of the body's turning (TURNED): the
// values do not follow these, each group tells them beside values of its own.
enum Unknown : int { STIFFNESS, DAMPING, SLIP_TORQUE, ASIDE, ABOVE, COMPLIANCE, LATE, TURNED };
constexpr int UNKNOWNS = 8;
// What each block has of its own: an offset, its drift, the zero of the yaw torque, which pitch turns into roll, and
// where between its bounds the element was when the block began.
enum Own : int { OFFSET, SLOPE, TWIST, BEGINNING };
constexpr int OWN = 4;
constexpr int BLOCK_UNKNOWNS = OWN + UNKNOWNS;

// Where noise enters: the deflection or the rate, alone or with an element that does not slip, the load, or the
// horizontal force.
enum NoiseSource : int { OF_ANGLE, OF_RATE, OF_ANGLE_AND_ELEMENT, OF_RATE_AND_ELEMENT, OF_LOAD, OF_HORIZONTAL };
constexpr int NOISE_SOURCES = 6;
// Sums over rows: each source's variance; the horizontal force's times the load, and times its square; and what an
// angle's and a rate's have in common with the element that follows them.
enum NoiseSum : int { BY_LOAD = NOISE_SOURCES, BY_LOAD_SQUARED, ANGLE_BY_ELEMENT, RATE_BY_ELEMENT, NOISE_SUMS };
// One line a source, and one for what the load's changes add to the horizontal force's.
constexpr int NOISE_LINES = NOISE_SOURCES + 1;

constexpr double COLOUR = 8.0;  // rows in a cycle of the filter: so many say the same
constexpr int MOST_GROUPS = 12;
constexpr int FEWEST_GROUPS = 3;        // that say how they differ
constexpr double FIRST_GROUP = 1.0;     // s of rows in one group, in the beginning
constexpr double LARGEST_GROUP = 8.0;   // s: errors hang together for less
constexpr double MEMORY = 2.0;          // fillings of each group that are remembered
constexpr double FIRST_BLOCK = 2.5;     // s with one offset, of a foot that stands, until groups say how they differ
constexpr double BLOCK = 5.0;           // groups, from then on: in a short block the offset takes most of a slow motion
constexpr double LONGEST_BLOCK = 10.0;  // s
constexpr double MOST_NOISE = 0.9;      // of a square: beyond, nothing of it is known
constexpr int FEWEST_ROWS = 8;          // of a block: with fewer its offset takes most of it

struct RegressionRow {
  double own[OWN];  // what the filter has made of a constant, the time, what turns with the pitch, the element's gap
  double columns[UNKNOWNS];
  double torque;
  double noise[NOISE_SOURCES];  // variance, of each source
};

struct RegressionPrior {
  std::array<double, UNKNOWNS> scale;  // a usual size of each column
  std::array<double, UNKNOWNS> mean;   // of each unknown, before any data, and how far it may be off
  std::array<double, UNKNOWNS> spread;
  double element_slope;  // of the element's state over the deflection, where it does not slip [1/rad]
  double element_share;  // of the deflection's noise, that the element follows
  double element_lag;    // what it follows of the rate's noise [s]
  double load_arm;       // torque that the sensor's load and horizontal force bring with them to the bush [m]
  double horizontal_arm;
  double twist;       // how far the yaw torque's zero may be off [N·m]; 0: of no account about this axis
  double noise_time;  // rows' noise hangs together for so long [s]
};

// A column that the values do not follow: what it multiplies, as groups differ in it, and as the rows' noise has it.
struct Untold {
  double value = 0.0, grouped = 0.0, white = 0.0;
};

struct AxisValues {
  std::array<double, UNKNOWNS> value = {};
  // Deviations: by how much groups differ; what errors leave that hang together no longer than noise does, of which few
  // groups may show less by chance; by what the prior may be off.
  std::array<double, UNKNOWNS> grouped = {}, white = {}, told = {};
  std::array<double, UNKNOWNS> std = {};       // all of it
  std::array<double, UNKNOWNS> resolved = {};  // what the rows' scatter and the prior alone would leave
  std::array<double, UNKNOWNS> moved = {};  // by the block that is open, of which no group has told yet how it differs
  double by_element = 0.0;                  // of the stiffness, by what was told of the element's torque
  double held = 0.0;  // share of the compliance's way from what the rows alone say to the prior's mean
  double offset = 0.0;
  Untold late, turned;                      // than was told [s]; of the turning's rate, the IMU's delay times K [N·m·s/rad]
  std::array<double, UNKNOWNS> by_late = {};  // what a torque that is later by a second adds to each value
  int groups = 0;

  // Whether the stiffness is one of a bush: where nothing moves, what is left beside the noise can be anything.
  bool plausible(double stiffest) const noexcept { return value[STIFFNESS] > 0.0 && value[STIFFNESS] < stiffest; }
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
  // What speaks for a jump so far, and to believe it for other reasons.
  const ChangeWatch& suspicion() const noexcept { return watch_; }
  void jump() noexcept;
  // Whether the last rows are those of no bush on no ground: they are thrown away with their block.
  bool doubted() const noexcept { return watch_.doubted(); }
  void forget_suspicion() noexcept { watch_.forget(); }
  void set_spread(Unknown unknown, double spread) noexcept { prior_.spread[unknown] = spread; }

  // One piece of the work that keeps `values` current, each short enough for one tick.
  void work() noexcept;
  const AxisValues& values() const noexcept { return values_; }

 private:
  using Shared = RootTriangle<UNKNOWNS>;
  struct Part {
    Shared triangle;
    double noise[NOISE_SUMS] = {};
    double rows = 0.0;
    void add(const Part& other) noexcept;
    void fade(double left) noexcept;
    double excitation(double scale) const noexcept;
    // Of a product with a source's noise, over its variance.
    double over(NoiseSum product, NoiseSource source) const noexcept {
      return noise[source] > 0.0 ? noise[product] / noise[source] : 0.0;
    }
  };
  struct Group : Part {
    double time = 0.0;
  };

  RootTriangle<BLOCK_UNKNOWNS> pinned() const noexcept;
  Part open_part() const noexcept;
  void open_block() noexcept;
  void take(const Part& part) noexcept;
  void merge_pairs() noexcept;
  void sum_up() noexcept;
  // With the prior, without the noise: the triangle that the values are solved from.
  Shared completed(const Part& data) const noexcept;
  using Line = std::array<double, UNKNOWNS + 1>;
  Line direction(int source, const Part& data) const noexcept;
  // What noise has added to the squares of some rows is the squares of these.
  std::array<Line, NOISE_LINES> noise_lines(const Part& data) const noexcept;
  void solve() noexcept;
  void find_moved() noexcept;
  void find_deviations() noexcept;
  bool turns() const noexcept;
  Untold untold(Unknown column) const noexcept;
  void watch(const RegressionRow& row, double dt) noexcept;
  void end_probe() noexcept;

  RegressionPrior prior_;
  RootTriangle<BLOCK_UNKNOWNS> open_;  // its own first
  int open_rows_ = 0;
  double open_time_ = 0.0, open_noise_[NOISE_SUMS] = {}, last_time_ = 0.0;
  std::array<Group, MOST_GROUPS> groups_;
  int used_ = 0, current_ = 0;
  bool full_ = false;
  double group_time_ = FIRST_GROUP;
  Part total_;
  double noise_ = 0.0;     // of a row, as much as rows that hang together leave [N·m]
  double together_ = 1.0;  // rows with the same noise
  bool changed_ = false, unsure_ = false, fresh_ = false;
  std::array<double, UNKNOWNS> closed_ = {};  // values without the open block
  bool jumped_ = false;
  ChangeWatch watch_;
  AxisValues values_, before_;  // now, and before a jump was suspected
  double noise_before_ = 0.0;
};

}  // namespace plantar
