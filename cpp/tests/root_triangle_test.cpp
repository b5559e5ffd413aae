// Least squares in square-root form against sums of products.
#include "online/root_triangle.hpp"

#include <random>

#include "check.hpp"

namespace root_triangle_test {

using plantar::RootTriangle;

constexpr int N = 3;
using Rows = double[50][N + 1];

void fill(Rows& rows) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (auto& row : rows) {
    for (int i = 0; i < N; ++i) row[i] = normal(random);
    row[N] = 2.0 * row[0] - 3.0 * row[1] + 0.5 * row[2] + 0.1 * normal(random);
  }
}

RootTriangle<N> fed(const Rows& rows, int count) {
  RootTriangle<N> root;
  for (int r = 0; r < count; ++r) {
    double row[N + 1];
    std::copy(rows[r], rows[r] + N + 1, row);
    root.add(row);
  }
  return root;
}

double product(const RootTriangle<N>& root, int i, int j) {
  double sum = 0.0;
  for (int k = 0; k <= N; ++k) sum += root.r[k][i] * root.r[k][j];
  return sum;
}

void run() {
  Rows rows;
  fill(rows);
  const RootTriangle<N> all = fed(rows, 50);
  for (int i = 0; i <= N; ++i)
    for (int j = 0; j <= N; ++j) {
      double sum = 0.0;
      for (const auto& row : rows) sum += row[i] * row[j];
      check::near(product(all, i, j), sum, 1e-10, "products of all rows");
    }

  RootTriangle<N> joined = fed(rows, 20), rest;
  for (int r = 20; r < 50; ++r) rest.add(rows[r]);
  joined.add(rest);
  double x[N], y[N];
  all.solve(x), joined.solve(y);
  for (int i = 0; i < N; ++i) check::near(x[i], y[i], 1e-12, "two parts joined");
  check::near(x[1], -3.0, 0.1, "the value behind the rows");

  fill(rows);
  RootTriangle<N> less = fed(rows, 50);
  less.remove(rows[49], 0.99);
  fill(rows);
  const RootTriangle<N> wanted = fed(rows, 49);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= N; ++j) check::near(product(less, i, j), product(wanted, i, j), 1e-9, "a row taken off");

  RootTriangle<N> most = all;
  double huge[N + 1] = {1e3, 0.0, 0.0, 0.0};
  most.remove(huge, 0.75);
  check::near(product(most, 0, 0), 0.25 * product(all, 0, 0), 1e-9, "of a square no more than its share goes");

  RootTriangle<N> faded = all;
  faded.scale(0.5);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= N; ++j) check::near(product(faded, i, j), 0.25 * product(all, i, j), 1e-9, "squares of half");

  RootTriangle<N> silent;
  for (auto& row : rows) {
    double without[N + 1] = {row[0], 0.0, row[2], 2.0 * row[0] + 0.5 * row[2]};
    silent.add(without);
  }
  double z[N];
  silent.solve(z);
  check::near(z[0], 2.0, 1e-9, "beside an unknown that no row has");
  check::that(z[1] == 0.0, "an unknown that no row has");
  check::near(z[2], 0.5, 1e-9, "behind an unknown that no row has");

  // What a filter leaves of a signal that has ended: its squares vanish.
  RootTriangle<N> empty;
  double tiny[N + 1] = {0.0, 1e-170, 1e-300, 0.0};
  empty.add(tiny);
  for (int i = 0; i <= N; ++i)
    for (int j = 0; j <= N; ++j) check::that(std::isfinite(empty.r[i][j]), "a row too small for squares");
}

const check::Listed listed(run);

}  // namespace root_triangle_test
