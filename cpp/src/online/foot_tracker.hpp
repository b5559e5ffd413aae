// One foot from tick to tick: contact, what may be learnt from it, and both axes' regressions.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "online/air_zero.hpp"
#include "online/axis_published.hpp"
#include "online/axis_regression.hpp"
#include "online/bent_joints.hpp"
#include "online/causal_filter.hpp"
#include "online/contact_gate.hpp"
#include "online/delay_line.hpp"
#include "online/delay_watch.hpp"
#include "online/edge_watch.hpp"
#include "online/element_state.hpp"
#include "online/filtered_row.hpp"
#include "online/foot_kinematics.hpp"
#include "online/foot_noise.hpp"
#include "online/memory_watch.hpp"
#include "online/shaking.hpp"
#include "online/slip_gate.hpp"
#include "online/smooth_angle.hpp"
#include "online/sole.hpp"
#include "plantar/foot_estimator.hpp"

namespace plantar {

inline bool has_element(const FootModel& foot, int axis) noexcept { return foot.slip_angle[axis] > 0.0; }

class FootTracker {
 public:
  FootTracker(const EstimatorModel& model, const FootModel& foot);

  // The wrench at the bush, the load and the centre of pressure of this tick. position: of all joints.
  void read(const FootKinematics& motion, const std::array<double, 6>& raw, std::span<const double> position) noexcept;
  // What speaks against all feet's readings: a slide of their soles, sensors that contradict each other.
  struct Doubt {
    SlipGate::Verdict slips;
    bool contradiction;
    bool late, late_imu;
    bool still;  // an encoder that may be frozen, a clock that jumps
  };
  // Contact, and what this tick teaches. others: load of the other feet; fresh: the tick before was read as well, `dt`
  // earlier.
  void learn(const FootKinematics& motion, double others, Doubt doubt, bool fresh, double time, double dt,
             double period) noexcept;
  // The elements that were told have followed a deflection that was wrong: nobody knows how they are bent now.
  void lose_elements() noexcept;
  // What was learnt came from a reading that was wrong from the beginning.
  void forget() noexcept;
  // A tick without readings that can be used, for `reason`.
  void miss(std::uint32_t reason) noexcept;
  // One piece of the regressions' work, of PIECES.
  static constexpr int PIECES = 4;
  void work(int piece) noexcept;

  // What speaks for ground that is softer, or stiffer, than it was [log-likelihood]; and to believe it.
  std::array<double, 2> suspicion() const noexcept;
  void change_ground() noexcept;

  double load() const noexcept { return estimate_.load; }
  ContactState contact() const noexcept { return gate_.contact(); }
  // Of both axes' torques behind their deflections, and of the IMU behind the encoders.
  Lateness lateness() const noexcept { return Lateness(late_[0]) += late_[1]; }
  Lateness imu_lateness() const noexcept { return Lateness(late_imu_[0]) += late_imu_[1]; }
  // Whether a swing has shown the force sensor's zero.
  bool zero_known() const noexcept { return zero_.known(); }
  const FootEstimate& estimate() const noexcept { return estimate_; }

 private:
  static constexpr int HELD = 32;  // rows that wait until the foot has not lifted behind them
  struct HeldRow {
    double time, dt;
    FilteredRow signals;
  };

  // A tick's signals in the middle of its period, in the order of `angles_` and `forces_`; the parts of its rates that are
  // a mean of both ends and a difference, and their mean over the period.
  struct Middle {
    double time, dt;
    bool stands, rolls, lands;
    std::array<double, 8> angles = {};
    std::array<double, 11> forces = {};
    double of_ends[2] = {}, difference[2] = {}, mean_rate[2] = {};
  };

  void restart_filter() noexcept;
  void filter(const FootKinematics& motion, double time, double dt, double period) noexcept;
  void follow_elements(const Middle& row, double time, double dt) noexcept;
  void unload_elements() noexcept;
  void hold(double time, double dt, const double* channels) noexcept;
  void commit(double before) noexcept;
  void give(const HeldRow& row) noexcept;
  void end_stance() noexcept;
  bool leans(const FootKinematics& motion, double inside, double dt) noexcept;
  void close_blocks() noexcept;
  void publish(int axis) noexcept;

  const FootModel* foot_;
  BentJoints joints_;
  double weight_, least_load_;
  Outline outline_;
  double middle_depth_, delay_, cutoff_;
  FootNoise noise_;
  double gain_std_, delay_std_;
  double period_ = 0.0;
  ContactGate gate_;
  AirZero zero_;
  Shaking shaking_;
  EdgeWatch edge_;
  CausalFilter<FilteredRow::CHANNELS> filter_;
  DelayLine<8> angles_;  // of both axes: angles, rates, angles without noise, the gyroscope's part of the rates
  std::array<SmoothAngle, 2> smooth_;
  DelayLine<11> forces_;  // load, horizontal forces, both torques, their rates, angles and rates of joints that bend
  std::array<AxisRegression, 2> axes_;
  std::array<MemoryWatch, 2> memories_;  // of axes whose model has no element
  Parameter learnt_compliance_[2];       // of the slide beside the model's, as each axis has it
  double slip_angle_[2];                 // of the model's element, or of the one that a memory is looked for with
  std::array<double, 6> raw_ = {}, wrench_ = {};
  std::array<double, 2> bends_ = {};      // of pitch and roll, by joints that bend beyond their encoders [rad]
  std::array<double, 7> before_ = {};     // load, force x, y, both torques, both `bends_`, of the last tick
  double turning_before_[2] = {};
  Middle last_ = {}, before_last_ = {};
  int middles_ = 0;                       // of ticks that followed each other, up to three
  ElementState element_[2], hanging_[2];  // now, and in the air
  double opened_[2] = {};                 // the elements' gaps when the offset of the rows began
  Lateness late_[2], late_imu_[2];        // as its own axes show it
  bool told_late_ = false;                // as both of them do together, or all feet's
  bool flat_ = false;                     // the centre of pressure is inside the sole
  bool stood_ = false;                    // it stood at the last tick
  bool lifted_ = false;                   // its elements are followed from its last stance, through the air
  bool left_out_ = false;                 // on its edge, as far as its sensor can tell, or an encoder is in doubt
  double beside_time_ = 0.0;              // s for which the centre of pressure has read beside the sole
  double inside_until_ = std::numeric_limits<double>::lowest();            // the last time at which it was not on its edge
  bool rolled_ = false;                   // the sole was rolling over its edge at the last tick
  double angles_before_[2] = {}, rates_before_[2] = {};  // of the last tick that the elements have followed
  bool begun_elements_ = false;                          // their bounds are those of a bush somewhere on its way
  bool running_ = false;                                 // the filter has begun
  double begun_ = 0.0;                                   // at this time
  double pause_ = 0.0;                                   // s for which the lines still hold ticks that were left out
  double told_change_ = 0.0;                             // s for which a change of ground is still told
  double row_time_ = 0.0;                                // since the last row
  int row_ticks_ = 0;
  std::array<HeldRow, HELD> held_;
  int first_held_ = 0, held_count_ = 0;
  FootEstimate estimate_;
};

}  // namespace plantar
