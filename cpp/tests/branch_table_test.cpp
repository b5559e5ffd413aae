// A table's values: linear between its places, which need not be even, and constant beyond both ends.
#include <algorithm>
#include <vector>

#include "branch_curve.hpp"
#include "check.hpp"

namespace branch_table_test {

using namespace plantar;

// Places that crowd at one end, as those of a branch do, and their squares.
std::vector<double> places() {
  std::vector<double> at;
  for (int i = 0; i <= 40; ++i) at.push_back(1.0 - std::pow(0.8, i));
  return at;
}

void every_segment_is_a_line_through_its_ends() {
  const std::vector<double> at = places();
  std::vector<double> squares(at.size());
  std::transform(at.begin(), at.end(), squares.begin(), [](double x) { return x * x; });
  const Table table(at.data(), at.size());
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (const double share : {0.0, 0.25, 0.5, 0.99}) {
      const double x = at[i] + share * (at[i + 1] - at[i]);
      check::near(table.value(x, squares.data(), 1), squares[i] + share * (squares[i + 1] - squares[i]), 1e-14, "inside");
    }
  check::near(table.value(-1.0, squares.data(), 1), squares.front(), 0.0, "before the first place");
  check::near(table.value(2.0, squares.data(), 1), squares.back(), 0.0, "beyond the last place");
  check::near(table.value(at[3], squares.data() + at.size() - 1, -1), squares[at.size() - 4], 1e-14, "backwards");
}

void run() {
  every_segment_is_a_line_through_its_ends();
}

const check::Listed listed(run);

}  // namespace branch_table_test
