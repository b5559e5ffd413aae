// The least that tests need: checks that print what fails, and a list of the tests of all files.
#pragma once

#include <cmath>
#include <cstdio>
#include <vector>

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

inline std::vector<void (*)()> all;

// At the end of each file: its tests are run, too.
struct Listed {
  explicit Listed(void (*tests)()) { all.push_back(tests); }
};

}  // namespace check
