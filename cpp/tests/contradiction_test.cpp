// A gyroscope that does not turn as the attitude does, and how soon that is over.
#include "online/contradiction.hpp"

#include <cmath>

#include "check.hpp"

using namespace plantar;

namespace {

constexpr double PERIOD = 0.005, BEGIN = 5.0, END = 9.0, LAST = 12.0;  // s: of the samples, of the fault
constexpr double SWAY = 0.05, PACE = 6.0;                              // rad, rad/s: of a chest that pitches

struct Told {
  bool before = false;  // the fault
  double during = 0.0;  // share of the fault's time
  double after = 0.0;   // s behind its end, for which the sensors still seem to differ
};

// The gyroscope reads `gain` times what turns, for four seconds.
Told with_gain(double gain) {
  TurnWatch watch;
  Told told;
  for (double time = 0.0; time < LAST; time += PERIOD) {
    const double angle = SWAY * std::sin(PACE * time), middle = time - 0.5 * PERIOD;
    const bool faulty = time >= BEGIN && time < END;
    const double mean = SWAY * PACE * std::cos(PACE * middle) * (faulty ? gain : 1.0);
    const double rate[3] = {0.0, mean, 0.0};
    const bool differ = watch.differ({-std::sin(angle), 0.0, std::cos(angle)}, rate, PERIOD);
    if (time < BEGIN) told.before = told.before || differ;
    if (faulty) told.during += differ * PERIOD / (END - BEGIN);
    if (time >= END && differ) told.after = time - END;
  }
  return told;
}

void a_fault_is_told_and_soon_over() {
  for (const double gain : {180.0 / std::acos(-1.0), -1.0, 0.0}) {
    const Told told = with_gain(gain);
    check::that(!told.before, "nothing is told of sensors that agree");
    check::that(told.during > 0.8, "a gyroscope that turns otherwise");
    check::that(told.after < 0.85, "itself again within a second");
  }
}

}  // namespace

int main() {
  a_fault_is_told_and_soon_over();
  return check::result();
}
