// Least squares in square-root form: an upper triangle R with its right-hand side, fed row by row with Givens
// rotations.
#pragma once

#include <algorithm>
#include <cmath>

namespace plantar {

// N unknowns; column N is the right-hand side, row N the root of the squares that no unknown explains.
template <int N>
struct RootTriangle {
  double r[N + 1][N + 1] = {};

  // Adds one row (N + 1 values, of which those before `first` are zero); the row is used up.
  void add(double* row, int first = 0) noexcept {
    for (int i = first; i <= N; ++i) {
      const double length = std::sqrt(r[i][i] * r[i][i] + row[i] * row[i]);
      if (length == 0.0) continue;  // both may be so small that their squares vanish
      const double c = r[i][i] / length, s = row[i] / length;
      r[i][i] = length;
      for (int j = i + 1; j <= N; ++j) {
        const double above = r[i][j];
        r[i][j] = c * above + s * row[j];
        row[j] = c * row[j] - s * above;
      }
    }
  }

  void add(const RootTriangle& other) noexcept {
    for (int i = 0; i <= N; ++i) {
      double row[N + 1];
      std::copy(other.r[i], other.r[i] + N + 1, row);
      add(row, i);
    }
  }

  // All rows weigh `factor` of what they did.
  void scale(double factor) noexcept {
    for (auto& row : r)
      for (double& value : row) value *= factor;
  }

  // Takes a row off again; at most a `share` of what the triangle has along it may go. The row is used up.
  void remove(double* row, double share) noexcept {
    for (int i = 0; i < N; ++i) {
      if (row[i] == 0.0) continue;
      const double most = std::sqrt(share) * r[i][i];
      if (std::abs(row[i]) > most) {
        const double left = most / std::abs(row[i]);
        for (int j = i; j <= N; ++j) row[j] *= left;
      }
      const double s = r[i][i] > 0.0 ? row[i] / r[i][i] : 0.0, c = std::sqrt(1.0 - s * s);
      for (int j = i; j <= N; ++j) {
        const double above = r[i][j];
        r[i][j] = (above - s * row[j]) / c;
        row[j] = (row[j] - s * above) / c;
      }
    }
  }

  // x with R x = right-hand side; an unknown that no row has is zero.
  void solve(double (&x)[N]) const noexcept {
    for (int i = N - 1; i >= 0; --i) {
      double left = r[i][N];
      for (int j = i + 1; j < N; ++j) left -= r[i][j] * x[j];
      x[i] = r[i][i] != 0.0 ? left / r[i][i] : 0.0;
    }
  }
};

}  // namespace plantar
