// One program for the tests of all files, which share their headers and are compiled as one. Exit code 0 is a pass.
#include "check.hpp"

int main() {
  for (const auto tests : check::all) tests();
  return check::failures == 0 ? 0 : 1;
}
