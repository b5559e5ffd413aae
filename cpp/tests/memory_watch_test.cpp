// When rubber with a memory is suspected, and when it is excluded: a spring, a damper and an element of 6 mrad.
#include "online/memory_watch.hpp"

#include <algorithm>
#include <cmath>

#include "check.hpp"

namespace memory_watch_test {

using namespace plantar;

constexpr double ROW = 0.025;                   // s
constexpr double STIFF = 800.0, SLIPS = 0.006;  // N·m/rad, rad
constexpr double WORTH = 0.05 * STIFF * SLIPS;  // N·m: an element that adds a twentieth of the stiffness

const RegressionPrior PRIOR = {{0.01, 0.1, 1.0, 600.0, 60.0, 4e4, 60.0, 0.1},
                               {},
                               {6e4, 6e4, 600.0, 1e-9, 1e-9, 1e-12, 1e-9, 1e-9},
                               0.0,
                               1.0 / SLIPS,
                               0.0,
                               0.0,
                               0.0,
                               0.0,
                               ROW};

// Rubber that is swayed by `size` [rad], its element slips at `slip` [N·m]; the torque scatters.
struct Sway {
  double size = 0.02, slip = 0.0, scatter = 0.01, middle = 0.0;
  MemoryWatch watch = MemoryWatch(PRIOR);
  double element = 0.0, before = 0.0;
  int row = 0;

  // `filtered`: what the filter makes of a constant.
  void go(int rows, double filtered = 1.0) {
    for (const int end = row + rows; row < end; ++row) {
      const double time = ROW * row, angle = middle + size * std::sin(2.0 * time),
                   rate = 2.0 * size * std::cos(2.0 * time);
      element = std::clamp(element + (angle - before) / SLIPS, -1.0, 1.0), before = angle;
      const double torque = STIFF * angle + 20.0 * rate + slip * element + 1.0 + scatter * std::sin(1e5 * row);
      watch.add({{filtered, time, 0.0}, {angle, rate, element}, torque, {}}, ROW);
      watch.work();
    }
  }
};

void it_is_excluded_by_motions_that_would_have_shown_it() {
  for (const double size : {0.0145, 0.0155}) {
    Sway sway{size};
    sway.go(4000);
    check::that(!sway.watch.seen(), "there is none");
    check::that(sway.watch.excluded() == (size > 0.015),
                "29 mrad back and forth say nothing of what slips at 15, 31 do");
    sway.watch.restart();
    check::that(!sway.watch.excluded() && !sway.watch.seen(), "nothing is known of it anew");
    sway.size = 0.01, sway.go(2000);
    check::that(!sway.watch.excluded(), "nor what was moved before");
  }
}

void an_element_is_seen_where_it_is_worth_it() {
  for (const double share : {0.8, 1.2, 10.0}) {
    Sway sway{0.02, share * WORTH};
    sway.go(3000);
    check::near(sway.watch.values().value[SLIP_TORQUE], share * WORTH, 0.05 * WORTH, "its torque");
    check::that(sway.watch.seen() == (share > 1.0), "more than a twentieth of the stiffness");
    check::that(sway.watch.excluded() == (share < 1.0), "or less, and surely");
    sway.watch.restart();
    check::that(!sway.watch.seen(), "forgotten");
  }
}

// The more the torque scatters, the less is sure: both verdicts at their number of deviations.
void both_verdicts_are_sure() {
  bool often[4] = {};
  for (double scatter = 0.02; scatter < 30.0; scatter *= 1.15)
    for (const double slip : {0.0, 2.0 * WORTH}) {
      Sway sway{0.02, slip, scatter};
      sway.go(1200);
      const AxisValues& found = sway.watch.values();
      const double torque = found.value[SLIP_TORQUE], own = found.resolved[SLIP_TORQUE];
      if (torque > WORTH) check::that(sway.watch.seen() == (torque > 4.0 * own), "four deviations");
      check::that(sway.watch.excluded() == (torque + 2.0 * own < WORTH), "two deviations");
      often[0] |= sway.watch.seen(), often[1] |= torque > WORTH && torque > 2.8 * own && !sway.watch.seen();
      often[2] |= sway.watch.excluded(), often[3] |= torque + own < WORTH && !sway.watch.excluded();
    }
  check::that(often[0] && often[1] && often[2] && often[3], "all of it was tried");
}

// With few groups nothing is said; small motions must agree over more of them, and exclude nothing.
void groups_must_agree() {
  for (const double slip : {0.0, 4.0 * WORTH})
    for (const double size : {0.012, 0.02}) {
      Sway sway{size, slip};
      int first = 0;  // groups
      for (int i = 0; i < 2000 && first == 0; ++i) {
        sway.go(1);
        if (sway.watch.seen() || sway.watch.excluded()) first = sway.watch.values().groups;
      }
      const bool far = size > 0.015;
      check::that(far          ? first >= 3 && first < 6
                  : slip > 0.0 ? first >= 6
                               : first == 0,
                  "three groups of large motions, or six");
    }
}

// What the filter has not settled on is no motion, and each block begins anew.
void a_way_is_one_block_s() {
  for (const double filtered : {0.985, 0.995}) {
    Sway sway{0.02};
    sway.go(400, filtered);
    sway.size = 0.012, sway.go(2000);
    check::that(sway.watch.excluded() == (filtered > 0.99), "a filter that has settled");
  }
  Sway apart{0.014};
  for (int block = 0; block < 8; ++block) {
    apart.middle = block % 2 ? 0.02 : -0.02;
    apart.go(300), apart.watch.close();
  }
  check::that(!apart.watch.excluded(), "28 mrad in each, however far apart");
}

// Rubber that has a memory in every other block: of small motions the groups' scatter counts, of large ones the rows'.
void groups_that_differ_show_none_in_small_motions() {
  for (const double size : {0.0145, 0.02}) {
    Sway sway{size};
    for (int block = 0; block < 8; ++block) {
      sway.slip = block % 2 ? 8.0 * WORTH : 0.0;
      sway.go(400), sway.watch.close();
    }
    const AxisValues& found = sway.watch.values();
    const double torque = found.value[SLIP_TORQUE];
    check::that(torque > 4.0 * found.resolved[SLIP_TORQUE] && torque > WORTH, "rows that scatter little");
    check::that(torque < 4.0 * found.std[SLIP_TORQUE], "groups that differ");
    check::that(sway.watch.seen() == (size > 0.015), "large motions alone show it");
  }
}

void the_longest_way_counts() {
  Sway sway{0.02};
  sway.go(400), sway.watch.close();
  sway.size = 0.012, sway.go(2000);
  check::that(sway.watch.excluded(), "what was moved far stays tested");
}

void run() {
  groups_that_differ_show_none_in_small_motions();
  the_longest_way_counts();
  it_is_excluded_by_motions_that_would_have_shown_it();
  an_element_is_seen_where_it_is_worth_it();
  both_verdicts_are_sure();
  groups_must_agree();
  a_way_is_one_block_s();
}

const check::Listed listed(run);

}  // namespace memory_watch_test
