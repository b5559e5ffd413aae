// Intervals of few groups, and one number that two axes have learnt.
#include "online/half_widths.hpp"

#include "check.hpp"

namespace half_widths_test {

using namespace plantar;

void few_groups_are_as_sure_as_student_says() {
  check::near(half_of_rows(3, 2.0, 0.0), 2.0 * 4.303, 1e-12, "three groups have two degrees of freedom");
  check::near(half_of_rows(4, 2.0, 0.0), 2.0 * 3.182, 1e-12, "four have three");
  check::near(half_of_rows(12, 2.0, 0.0), 2.0 * 2.201, 1e-12, "the most have eleven");
  check::near(half_of_rows(2, 2.0, 0.0), 2.0 * 4.303, 1e-12, "fewer are no surer");
  check::near(half_of_rows(12, 2.0, 3.0), 1.96 * 3.0, 1e-12, "nor is anything surer than noise leaves it");
}

// Weights are one over the variances, 4 to 1: the mean lies a fifth of the way from the surer one, and their scatter
// about it is two fifths of what they are apart.
void two_axes_weigh_by_what_they_know() {
  const Parameter sure = {1e-5, 1e-6, 2.1e-6}, unsure = {3e-5, 2e-6, 4.2e-6};
  const double value = 1.4e-5, beside = std::hypot(0.8e-5, 0.07 * value);
  for (const bool swapped : {false, true}) {
    const Parameter found = swapped ? learnt_by_both(unsure, sure, 5e-6) : learnt_by_both(sure, unsure, 5e-6);
    check::near(found.value, 5e-6 + value, 1e-18, "the mean by weights, beside what was told");
    check::near(found.std, std::hypot(1e-6, beside), 1e-18, "the surer one's deviation, and how far they are apart");
    check::near(found.half_width, std::hypot(2.1e-6, 1.96 * beside), 1e-18, "and half width");
  }
  const Parameter none = learnt_by_both({}, {}, 5e-6);
  check::that(none.value == 5e-6 && none.std == 0.0 && none.half_width == 0.0, "nothing was learnt");
}

void run() {
  few_groups_are_as_sure_as_student_says();
  two_axes_weigh_by_what_they_know();
}

const check::Listed listed(run);

}  // namespace half_widths_test
