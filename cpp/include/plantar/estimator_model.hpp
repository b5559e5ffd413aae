// What the estimator knows of a robot: the joints from its IMU to its feet, its bushes, soles and force sensors.
//
// `plantar.FootEstimator.write_model` writes it as a small text file, so that a controller needs neither URDF nor YAML.
#pragma once

#include <array>
#include <istream>
#include <string>
#include <vector>

#include "plantar/frame.hpp"

namespace plantar {

// One joint on the way from the IMU to a foot; it turns about, or slides along, the z axis of its own frame.
struct PathJoint {
  int joint;    // its place in `Reading::position`
  bool slides;  // prismatic, else revolute
  double sign;  // -1 where it is passed from child to parent
  Frame frame;  // before it moves, in the frame behind the joint before
  double compliance = 0.0;  // by which it bends beyond its encoder [rad/(N·m)]
};

// Torque about one axis of a bush that is not the bush's: of a centre or a sensor that is not where it was told to be.
struct Misplaced {
  double aside = 0.0;   // of the bush's centre [m]: grows with the load
  double above = 0.0;   // of the bush's centre [m]: grows with the horizontal force
  double turned = 0.0;  // of the sensor [rad]: a share of the other axis' torque
  double leans = 0.0;   // of the sensor [rad]: a share of the yaw torque
};

// One foot: the way to it, its bush, its sole and its force sensor.
struct FootModel {
  std::string name;                                    // as in the robot file
  bool always = false;                                 // stands throughout: its force sensor was zeroed under load
  std::vector<PathJoint> path;                         // from the IMU to the foot
  Frame bush;                                          // behind the last joint
  Frame sole;                                          // in the bush frame, undeflected
  Frame sensor;                                        // the force sensor in the bush frame
  double sign = 1.0;                                   // -1 where it reads the robot's action on the ground
  std::vector<std::array<double, 2>> polygon;          // the sole's corners in its plane, counter-clockwise [m]
  std::array<double, 2> place_std = {0.0, 0.0};        // of the bush's centre, aside and above [m]
  std::array<Misplaced, 2> misplaced = {};             // of pitch and roll, as a batch fit has found it
  std::array<std::array<double, 2>, 2> unsure = {};    // deviation of K, C by joints that bend [share]
  double compliance = 0.0;                             // of the slide along the ankle's z [m/N]
  double compliance_std = 0.0;                         // deviation of `compliance` [m/N]
  std::array<double, 2> slip_angle = {0.0, 0.0};       // of a Jenkins element beside pitch and roll [rad]; 0: none
  std::array<double, 2> slip_torque = {0.0, 0.0};      // of these, before any data [N·m]; 0: not known
  std::array<double, 2> slip_torque_std = {0.0, 0.0};  // deviation of `slip_torque` [N·m]; 0: not known
  std::array<bool, 2> linear = {false, false};         // a batch fit has found no memory in pitch, in roll
};

// All that the estimator knows of a robot before its first reading.
struct EstimatorModel {
  std::string robot;                // its name
  double weight = 0.0;              // of the robot [N]
  double cutoff = 5.0;              // of the filters in front of the regressions [Hz]
  double wrench_delay = 0.0;        // force sensors behind the IMU [s]; negative: before it
  double wrench_delay_std = 0.0;    // its deviation [s]
  double wrench_gain_std = 0.0;     // deviation of the force sensors' gains [share]
  std::vector<std::string> joints;  // what `Reading::position` holds, in this order
  std::vector<FootModel> feet;      // `Reading::wrench` and the estimates have their order
};

// A model from the text of its file. Throws std::runtime_error with the line's number where the text is no such file.
EstimatorModel read_model(std::istream& text);

// The same from a path. Throws std::runtime_error where the file cannot be read.
EstimatorModel load_model(const std::string& path);

}  // namespace plantar
