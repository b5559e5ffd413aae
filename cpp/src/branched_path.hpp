// The walk of elements with memory along a deflection: from turning point to turning point.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace plantar {

// A deflection of n samples and r runs of it, first and end of each one after the other. A run has a memory of its own.
struct Path {
  const double* deflection;
  std::size_t n;
  const std::int64_t* runs;
  std::size_t r;
};

// States (n, b) of b variants of an element, NaN outside the runs. The element says where it begins in a run, `begin`,
// whose first branch goes up or down (`direction`), what a `turn` at the end of a branch leaves, and what the `states`
// are some way along one. A pause belongs to the branch before.
template <class Element>
void along_path(const Path& path, std::size_t b, Element& element, double* out) {
  std::size_t known = 0;
  for (std::size_t run = 0; run < path.r; ++run) {
    const auto first = static_cast<std::size_t>(path.runs[2 * run]);
    const auto end = static_cast<std::size_t>(path.runs[2 * run + 1]);
    std::fill(out + known * b, out + first * b, std::numeric_limits<double>::quiet_NaN());
    known = end;
    double direction = 1.0, turned = path.deflection[first];
    for (std::size_t i = first; i < end; ++i)
      if (path.deflection[i] != turned) {
        direction = path.deflection[i] > turned ? 1.0 : -1.0;
        break;
      }
    element.begin(run, direction);
    for (std::size_t i = first; i < end; ++i) {
      const double now = path.deflection[i], next = path.deflection[i + 1 < end ? i + 1 : i];
      if ((next - now) * direction < 0.0) {
        element.turn(std::abs(now - turned));
        direction = -direction;
        turned = now;
      }
      element.states(direction, std::abs(now - turned), out + i * b);
    }
  }
  std::fill(out + known * b, out + path.n * b, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace plantar
