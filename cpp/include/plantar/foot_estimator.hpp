// Where each foot stands, how its bush is bent and how fast, and what its stiffness and damping are now: every tick.
//
// Units are SI, angles in rad. A wrench is force then torque, of the environment on the robot: a standing robot reads
// force.z > 0. Pitch and roll turn the sole against the ankle, R_ankle_sole = Ry(pitch) Rx(roll), and
//     torque = stiffness·deflection + damping·rate + offset,
// pitch from torque y, roll from torque x, at the bush's centre.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "plantar/estimator_model.hpp"

namespace plantar {

// One tick's readings. Spans may be empty where a robot lacks the sensor; what is there must have the size that is
// said.
struct Reading {
  double time = 0.0;                 // of the readings, increasing [s]
  std::span<const double> position;  // of the joints, as `EstimatorModel::joints` [rad or m]
  std::span<const double> velocity;  // of the joints; empty: from the positions
  std::span<const double> attitude;  // quaternion w x y z, IMU to world; empty: from gyroscope and accelerometer
  std::span<const double> angular_velocity;  // 3, of the IMU in its own frame [rad/s]; empty: from the attitude
  std::span<const double> acceleration;      // 3, proper, in the IMU's frame [m/s²]; read where there is no attitude
  std::span<const std::array<double, 6>> wrench;  // of each foot's force sensor as it reads, in the order of the feet
};

// Whether a foot stands. The load that decides has a hysteresis.
enum class ContactState : std::uint8_t {
  air,      // it carries nothing
  landing,  // it is loaded and has not settled yet: nothing is learnt
  stance    // it stands
};

// Why something of a foot's estimate may not be trusted; several may hold at once.
enum Flag : std::uint32_t {
  INPUT_MISSING = 1 << 0,    // a value that this foot needs is not finite, or degrees: the last deflection is held
  FROZEN = 1 << 1,           // a sensor, or one channel of it, repeats itself: nothing is learnt
  TIME_FAULT = 1 << 2,       // time stood still, stepped back or jumped
  NOT_STANDING = 1 << 3,     // the sole is not known to lie flat: the deflection is no bush's
  EDGE = 1 << 4,             // the centre of pressure is at the sole's edge or beside it
  SLIP = 1 << 5,             // the soles move against each other
  IMPACT = 1 << 6,           // the force is shaken
  NEVER_LOADED = 1 << 7,     // this foot has not stood yet
  PITCH_UNKNOWN = 1 << 8,    // stiffness and damping of pitch are not identified yet
  ROLL_UNKNOWN = 1 << 9,     // the same of roll
  GROUND_CHANGED = 1 << 10,  // the stiffness jumped lately: it is learnt anew
  PITCH_MEMORY = 1 << 11,    // the rubber has a memory that the model lacks: other motions have another stiffness
  ROLL_MEMORY = 1 << 12,     // the same of roll
  PITCH_UNTESTED = 1 << 13,  // its motions were too small to show a memory, or to test the slip torque that was told
  ROLL_UNTESTED = 1 << 14,   // the same of roll
  // Gyroscope and attitude turn differently, the feet do not carry the weight, or a torque follows no bush's
  // deflection.
  CONTRADICTION = 1 << 15,
  LATE_WRENCH = 1 << 16,  // torques follow deflections as if the force sensors' delay were not the one that was given
  LATE_IMU = 1 << 17      // or as if the IMU were behind the encoders, or before them
};

// A parameter with its standard deviation and half of its 95 % interval (wider than 1.96 deviations while data are
// few).
struct Parameter {
  double value = 0.0;       // in the unit that stands where the parameter is used
  double std = 0.0;         // standard deviation
  double half_width = 0.0;  // half of the 95 % interval
};

// One axis of a foot's bush, pitch or roll.
struct AxisEstimate {
  double deflection = 0.0;  // [rad], of this tick: no filter, no delay
  double rate = 0.0;        // [rad/s], of this tick
  double torque = 0.0;      // [N·m], measured, about the bush's axis
  Parameter stiffness;      // [N·m/rad]
  Parameter damping;        // [N·m·s/rad]
  Parameter slip_torque;    // [N·m], of a Jenkins element where the model has one
  double offset = 0.0;      // [N·m], of this stance
  bool identified = false;  // whether the stiffness is known within a tenth, and a memory is tested or excluded
};

// One foot at one tick.
struct FootEstimate {
  ContactState contact = ContactState::air;               // whether it stands
  double load = 0.0;                                      // along the vertical [N]
  std::array<double, 2> centre_of_pressure = {0.0, 0.0};  // in the sole's frame [m]; the last one known in the air
  double compression = 0.0;                               // of the slide along the ankle's z, by the load [m]
  Parameter compliance;                                   // of that slide [m/N]; known where horizontal forces change
  AxisEstimate pitch;                                     // about the bush's y axis
  AxisEstimate roll;                                      // about its x axis, turned by pitch
  std::uint32_t flags = 0;                                // of `Flag`
};

// The estimator. It belongs to one thread at a time; each robot has its own.
class FootEstimator {
 public:
  // Throws std::invalid_argument where the model makes no sense. All memory is taken here.
  explicit FootEstimator(const EstimatorModel& model);

  // Gives the memory back.
  ~FootEstimator();

  // Moves; what was moved from may only be destroyed or assigned to. There is no copy.
  FootEstimator(FootEstimator&&) noexcept;

  // The same.
  FootEstimator& operator=(FootEstimator&&) noexcept;

  // One tick. Allocates nothing, locks nothing, throws nothing and calls no system. Returns one estimate for each foot
  // of the model, finite whatever was read, valid until the next step.
  std::span<const FootEstimate> step(const Reading& reading) noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace plantar
