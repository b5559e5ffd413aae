// How far an axis' values may be off, and by how much its torques or its IMU are late: from groups that are left out,
// from the rows' scatter, and from what the prior may be off by.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "online/axis_regression.hpp"

namespace plantar {

namespace {

constexpr double LEAST_LEFT = 1e-3;  // share of what is known that must stay when one group is left out
// What the body's turning has beside the other columns, as squares: else it would look like a delay.
constexpr double OVER_GYROSCOPE = 20.0;  // times the noise that the gyroscope brings to both
constexpr double OVER_ANGLES = 8.0;      // times what the noise of angles would be as a rate's
constexpr double OVER_ROUNDING = 1e-4;   // times the whole column: less where the joints stand
constexpr double ROUNDING = 1e-12;       // of a column's squares: what is left of it where the others say it all

void squares_of(const RootTriangle<UNKNOWNS>& root, double (&a)[UNKNOWNS][UNKNOWNS]) noexcept {
  for (int i = 0; i < UNKNOWNS; ++i)
    for (int j = i; j < UNKNOWNS; ++j) {
      a[i][j] = 0.0;
      for (int k = 0; k <= i; ++k) a[i][j] += root.r[k][i] * root.r[k][j];
      a[j][i] = a[i][j];
    }
}

// m x = b by elimination; m is positive definite and used up, as b is.
void solve_positive(double (&m)[UNKNOWNS][UNKNOWNS], double (&b)[UNKNOWNS], double (&x)[UNKNOWNS]) noexcept {
  for (int p = 0; p < UNKNOWNS; ++p)
    for (int i = p + 1; i < UNKNOWNS; ++i) {
      const double k = m[i][p] / m[p][p];
      for (int j = p; j < UNKNOWNS; ++j) m[i][j] -= k * m[p][j];
      b[i] -= k * b[p];
    }
  for (int i = UNKNOWNS - 1; i >= 0; --i) {
    x[i] = b[i];
    for (int j = i + 1; j < UNKNOWNS; ++j) x[i] -= m[i][j] * x[j];
    x[i] /= m[i][i];
  }
}

}  // namespace

void AxisRegression::find_moved() noexcept {
  for (int i = 0; i < UNKNOWNS; ++i)
    values_.moved[i] =
        used_ < FEWEST_GROUPS ? 0.0 : std::min(std::abs(values_.value[i] - closed_[i]), prior_.spread[i]);
}

void AxisRegression::find_deviations() noexcept {
  values_.groups = used_;
  if (used_ < FEWEST_GROUPS) return;
  const Shared whole = completed(total_);
  double x[UNKNOWNS], normal[UNKNOWNS][UNKNOWNS], mean[UNKNOWNS] = {}, moved[MOST_GROUPS][UNKNOWNS];
  whole.solve(x);
  for (int i = 0; i < UNKNOWNS; ++i) closed_[i] = x[i] / prior_.scale[i];
  find_moved();
  squares_of(whole, normal);
  for (int g = 0; g < used_; ++g) {
    // Without this group: x + (A - A_g)⁻¹ (A_g x - b_g).
    const Shared& part = groups_[g].triangle;
    double own[UNKNOWNS][UNKNOWNS], m[UNKNOWNS][UNKNOWNS], b[UNKNOWNS] = {};
    squares_of(part, own);
    for (const Line& line : noise_lines(groups_[g]))
      for (int i = 0; i < UNKNOWNS; ++i) {
        for (int j = 0; j < UNKNOWNS; ++j) own[i][j] -= line[i] * line[j];
        b[i] += line[i] * line[UNKNOWNS];
      }
    for (int i = 0; i < UNKNOWNS; ++i) {
      for (int j = 0; j <= i; ++j) b[i] -= part.r[j][i] * part.r[j][UNKNOWNS];
      for (int j = 0; j < UNKNOWNS; ++j) b[i] += own[i][j] * x[j], m[i][j] = normal[i][j] - own[i][j];
      m[i][i] = std::max(m[i][i], LEAST_LEFT * normal[i][i]);
    }
    solve_positive(m, b, moved[g]);
    for (int i = 0; i < UNKNOWNS; ++i) mean[i] += moved[g][i] / used_;
  }
  for (int i = 0; i < UNKNOWNS; ++i) {
    double squares = 0.0, m[UNKNOWNS][UNKNOWNS], unit[UNKNOWNS] = {}, row[UNKNOWNS];
    for (int g = 0; g < used_; ++g) squares += (moved[g][i] - mean[i]) * (moved[g][i] - mean[i]);
    squares *= (used_ - 1.0) / used_;
    unit[i] = 1.0;
    std::copy(&normal[0][0], &normal[0][0] + UNKNOWNS * UNKNOWNS, &m[0][0]);
    solve_positive(m, unit, row);
    const double resolved = noise_ * noise_ * std::max(row[i], 0.0);
    double told = 0.0;
    for (int j = 0; j < UNKNOWNS; ++j) {  // what the prior may be off by
      const double moves = row[j] * noise_ * noise_ / (prior_.spread[j] * prior_.scale[j]);
      told += moves * moves;
      if (i == COMPLIANCE && j == COMPLIANCE) values_.held = moves / (prior_.spread[j] * prior_.scale[j]);
      if (i == STIFFNESS && j == SLIP_TORQUE) values_.by_element = std::abs(moves) / prior_.scale[i];
    }
    const double white = std::max(resolved - told, 0.0) * together_ / COLOUR;
    const auto deviation = [&](double variance) {
      const double root = std::sqrt(variance) / prior_.scale[i];
      return std::isfinite(root) ? std::min(root, prior_.spread[i]) : prior_.spread[i];
    };
    values_.grouped[i] = deviation(squares), values_.white[i] = deviation(white), values_.told[i] = deviation(told);
    values_.std[i] = deviation(std::max(squares, white) + told), values_.resolved[i] = deviation(resolved);
  }
}

// Weighted by how much each group has to say.
Untold AxisRegression::untold(Unknown column) const noexcept {
  double weights = 0.0, sum = 0.0, squares = 0.0, whole = 0.0;
  for (int g = 0; g < used_; ++g) {
    const auto& r = groups_[g].triangle.r;
    weights += r[column][column] * r[column][column], sum += r[column][column] * r[column][UNKNOWNS];
    for (int i = 0; i <= column; ++i) whole += r[i][column] * r[i][column];
  }
  if (!(weights > ROUNDING * whole)) return {};
  const double mean = sum / weights;
  for (int g = 0; g < used_; ++g) {
    const auto& r = groups_[g].triangle.r;
    const double away = r[column][column] * (r[column][UNKNOWNS] - mean * r[column][column]);
    squares += away * away;
  }
  const double scale = prior_.scale[column];
  return {mean / scale, std::sqrt(squares * used_ / (used_ - 1.0)) / weights / scale,
          noise_ * std::sqrt(together_ / COLOUR / weights) / scale};
}

// Whether the body turns otherwise than the feet bend, by more than noise.
bool AxisRegression::turns() const noexcept {
  double beside = 0.0, whole = 0.0;
  for (int g = 0; g < used_; ++g) {
    const auto& r = groups_[g].triangle.r;
    for (int i = 0; i <= TURNED; ++i) whole += r[i][TURNED] * r[i][TURNED];
    beside += r[TURNED][TURNED] * r[TURNED][TURNED];
  }
  const double *noise = total_.noise, scale = prior_.scale[TURNED], edge = std::numbers::pi / prior_.noise_time / scale;
  const double gyroscope = (noise[OF_RATE] + noise[OF_RATE_AND_ELEMENT]) / (scale * scale);
  const double angles = (noise[OF_ANGLE] + noise[OF_ANGLE_AND_ELEMENT]) * edge * edge / 3.0;
  return beside > std::max({OVER_GYROSCOPE * gyroscope, OVER_ANGLES * angles, OVER_ROUNDING * whole});
}

}  // namespace plantar
