// The least that a test needs.
#pragma once

#include <cmath>
#include <cstdio>

namespace check {

inline int failures = 0;

inline void that(bool holds, const char* what) {
  if (holds) return;
  std::printf("FAILED: %s\n", what);
  ++failures;
}

inline void near(double found, double wanted, double within, const char* what) {
  if (std::abs(found - wanted) <= within) return;
  std::printf("FAILED: %s: %.12g, wanted %.12g within %g\n", what, found, wanted, within);
  ++failures;
}

inline int result() { return failures == 0 ? 0 : 1; }

}  // namespace check
