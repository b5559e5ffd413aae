// The chain of joints from the IMU to a foot: what the deflection kernel reads and writes (paper 3.2).
#pragma once

#include "columns.hpp"

namespace plantar {

// One joint of the path, about or along the z axis of its own frame. Frames are composed outwards from the
// IMU, so a joint that is passed from child to parent enters with sign -1.
struct ChainStep {
  Frame frame;    // of the joint, before it moves, in the frame after the step before
  bool slides;    // prismatic, else revolute
  double sign;    // +1 parent to child, -1 child to parent
  Column position;
  Column velocity;
};

struct Chain {
  const ChainStep* steps;
  std::size_t n_steps;
  Frame bush;  // in the frame after the last step
  Frame sole;  // in the bush frame when the bush is not deflected
};

struct Attitude {
  Column quaternion[4];        // w x y z, IMU to world
  Column angular_velocity[3];  // in the IMU frame
};

// Rows of the output, each one a contiguous array of all samples.
enum ChainOutput {
  UP = 0,               // 3: the world's up in the bush frame
  DEFLECTION = 3,       // 2: pitch, roll
  RATE = 5,             // 2
  SOLE_POSITION = 7,    // 3: from the IMU, world axes
  HEADING = 10,         // 1: of the sole's x axis in the world
  ENCODER_RATE = 11,    // 2: the part of RATE that the joints turn
  IMU_TURN = 13,        // 6: change of pitch, then of roll, with a turn of the IMU about its x, y and z
  CHAIN_OUTPUTS = 19
};

// The paths of some feet beside each other, INSTANTS columns each: of every step its frame, how far the joint's position
// turns and slides what follows (+1, -1 or 0), position and velocity; then bush and sole. Each number stands in as many
// doubles as the kernels have lanes.
constexpr int INSTANTS = 2;
enum BundleRow { STEP_ROTATION = 0, STEP_ORIGIN = 9, TURNS = 12, SLIDES = 13, POSITION = 14, VELOCITY = 15, STEP_ROWS = 16 };
enum BundleEnd { BUSH_ROTATION = 0, BUSH_ORIGIN = 9, SOLE_ROTATION = 12, SOLE_ORIGIN = 21, END_ROWS = 24 };

struct Bundle {
  const double* rows;  // (n_steps * STEP_ROWS + END_ROWS, lanes)
  std::size_t n_steps;
};

}  // namespace plantar
