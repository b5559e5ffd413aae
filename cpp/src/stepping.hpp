// Steps of a simulator in which each foot's rubber acts: what the engine cannot express, added at every step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plantar {

// One axis: a cubic spring, and an elastoplastic (Jenkins) element, a spring that slips at a fixed torque. `angle`:
// where the engine keeps the deflection; `applied`: where it takes a joint's torque from.
struct RubberElement {
  double stiffness, limit, hardening;
  std::size_t angle, applied;
  double elastic = 0.0, last = 0.0;

  // Torque against a deflection; call once a step, the history counts.
  double torque(double deflection) {
    double now = elastic + deflection - last;
    last = deflection;
    now = now > limit ? limit : now < -limit ? -limit : now;
    elastic = now;
    return stiffness * now + hardening * deflection * deflection * deflection;
  }
};

// The engine's own step, as its library exports it: (const model*, data*).
using EngineStep = void (*)(const void*, void*);

struct Stepping {
  EngineStep step;
  const void* model;
  void* data;
  const double* positions;  // the engine's generalised positions
  double* applied;          // its applied generalised forces
  double* control;          // its actuators' inputs
  std::vector<RubberElement> rubber;

  // One step for each row of `rows` (count, width), which go to the actuators.
  void run(const double* rows, std::size_t count, std::size_t width) {
    for (std::size_t row = 0; row < count; ++row, rows += width) {
      for (std::size_t k = 0; k < width; ++k) control[k] = rows[k];
      for (RubberElement& one : rubber) applied[one.applied] = -one.torque(positions[one.angle]);
      step(model, data);
    }
  }
};

}  // namespace plantar
