#include "online/axis_regression.hpp"

#include <algorithm>
#include <cmath>

namespace plantar {

namespace {

constexpr int GROUPS_TO_WATCH = 6;
constexpr double SETTLED = 0.1;   // deviation over stiffness, from which jumps are looked for
constexpr double DRIFT = 3e-5;    // rad/s, of the attitude: a tenth of a degree in a minute
constexpr double ANYWHERE = 0.6;  // deviation of what is anywhere between -1 and 1; an element is as stiff as the rest
constexpr double FIRST_NOISE = 1e-3;  // of the weight, as torque at 1 m, before any residual is known

}  // namespace

AxisRegression::AxisRegression(const RegressionPrior& prior) noexcept : prior_(prior) { restart(); }

void AxisRegression::Part::add(const Part& other) noexcept {
  triangle.add(other.triangle);
  for (int i = 0; i < NOISE_SUMS; ++i) noise[i] += other.noise[i];
  rows += other.rows;
}

void AxisRegression::open_block() noexcept {
  open_ = {}, open_rows_ = 0, open_time_ = 0.0;
  std::fill(open_noise_, open_noise_ + NOISE_SUMS, 0.0);
}

void AxisRegression::restart() noexcept {
  open_block();
  groups_ = {}, used_ = 1, current_ = 0, full_ = false, group_time_ = FIRST_GROUP;
  total_ = {};
  noise_ = FIRST_NOISE * prior_.scale[ASIDE];
  changed_ = unsure_ = fresh_ = false;
  watch_.restart();
  values_ = {};
  before_ = {};
  values_.value = prior_.mean, values_.std = values_.resolved = values_.grouped = prior_.spread;
}

// Rows are compared with what was learnt, once that is worth it; at a jump everything is learnt anew. While a jump is
// suspected, they are compared with what was learnt before.
void AxisRegression::watch(const RegressionRow& row, double dt) noexcept {
  if (watch_.calm() && !watch_.doubted()) before_ = values_, noise_before_ = noise_;
  const double stiffness = before_.value[STIFFNESS];
  const double unsure = std::max({before_.std[STIFFNESS], before_.resolved[STIFFNESS], before_.moved[STIFFNESS]});
  if (before_.groups < GROUPS_TO_WATCH || !before_.plausible(prior_.spread[STIFFNESS])) return;
  if (!(unsure < SETTLED * stiffness)) return;
  double left = row.torque;
  for (int i = 0; i < UNKNOWNS; ++i) left -= row.columns[i] * before_.value[i];
  const double unknown = ANYWHERE * std::abs(before_.value[SLIP_TORQUE]) * row.own[BEGINNING];
  const double* columns = row.columns;
  watch_.add(row.own[OFFSET], columns[DAMPING], columns[LATE], columns[STIFFNESS], unknown, left, dt);
  if (watch_.full()) end_probe();
}

void AxisRegression::end_probe() noexcept {
  const auto verdict = watch_.judge(before_.value[STIFFNESS], before_.std[STIFFNESS], noise_before_);
  if (verdict == ChangeWatch::Verdict::changed) jump();
  if (verdict == ChangeWatch::Verdict::impossible) open_block();
}

void AxisRegression::jump() noexcept {
  restart();
  jumped_ = true;
}

bool AxisRegression::jumped() noexcept {
  const bool since = jumped_;
  jumped_ = false;
  return since;
}

void AxisRegression::add(const RegressionRow& row, double dt) noexcept {
  watch(row, dt);
  double line[BLOCK_UNKNOWNS + 1];
  std::copy_n(row.own, OWN, line);
  for (int i = 0; i < UNKNOWNS; ++i) line[OWN + i] = row.columns[i] / prior_.scale[i];
  line[BLOCK_UNKNOWNS] = row.torque;
  last_time_ = row.own[SLOPE];
  open_.add(line);
  for (int i = 0; i < NOISE_SOURCES; ++i) open_noise_[i] += row.noise[i];
  const double load = row.columns[ASIDE];
  open_noise_[BY_LOAD] += row.noise[OF_HORIZONTAL] * load;
  open_noise_[BY_LOAD_SQUARED] += row.noise[OF_HORIZONTAL] * load * load;
  ++open_rows_, open_time_ += dt, fresh_ = true;
  if (dt > 0.0) together_ = std::clamp(prior_.noise_time / dt, 1.0, COLOUR);
  const bool first = used_ <= FEWEST_GROUPS;
  if (open_time_ >= (first ? FIRST_BLOCK : std::min(BLOCK * group_time_, LONGEST_BLOCK))) close();
}

// The open block with what is known of drift, twist and the element's beginning: they are small. A short block cannot
// tell them from a motion.
RootTriangle<BLOCK_UNKNOWNS> AxisRegression::pinned() const noexcept {
  RootTriangle<BLOCK_UNKNOWNS> block = open_;
  const double stiffness = values_.value[STIFFNESS] > 0.0 ? values_.value[STIFFNESS] : prior_.scale[ASIDE];
  const double element = prior_.element_slope > 0.0 ? ANYWHERE * stiffness / prior_.element_slope : 0.0;
  const double spreads[OWN] = {0.0, DRIFT * stiffness, prior_.twist, element};
  for (const Own own : {SLOPE, TWIST, BEGINNING}) {
    const double spread = spreads[own];
    double line[BLOCK_UNKNOWNS + 1] = {};
    if (spread > 0.0) line[own] = noise_ / spread;
    block.add(line, own);
  }
  return block;
}

AxisRegression::Part AxisRegression::open_part() const noexcept {
  Part part;
  const auto block = pinned();
  for (int i = 0; i <= UNKNOWNS; ++i)
    for (int j = i; j <= UNKNOWNS; ++j) part.triangle.r[i][j] = block.r[OWN + i][OWN + j];
  // The offset has taken the noise's slowest part with it, as the others have where they are not pinned. What an
  // element has of it is slower still: at no frequency its share is one, in the mean over those that pass
  // `element_share`.
  double taken = 0.0;
  for (int e = 0; e < OWN; ++e)
    if (block.r[e][e] > 0.0) taken += open_.r[e][e] * open_.r[e][e] / (block.r[e][e] * block.r[e][e]);
  const double share = open_time_ > 0.0 ? prior_.noise_time * taken / open_time_ : 1.0;
  const double left = std::max(1.0 - share, 0.0), slow = std::max(1.0 - share / prior_.element_share, 0.0);
  for (int i = 0; i < NOISE_SUMS; ++i) part.noise[i] = open_noise_[i] * left;
  part.noise[ANGLE_BY_ELEMENT] = open_noise_[OF_ANGLE_AND_ELEMENT] * prior_.element_share * slow;
  part.noise[RATE_BY_ELEMENT] = open_noise_[OF_RATE_AND_ELEMENT] * prior_.element_lag * slow;
  part.rows = open_rows_ - 1;
  return part;
}

void AxisRegression::close() noexcept {
  end_probe();  // of a short stance
  watch_.believe();
  if (open_rows_ >= FEWEST_ROWS) take(open_part());
  open_block();
}

void AxisRegression::take(const Part& part) noexcept {
  if (groups_[current_].time >= group_time_) {
    if (used_ == MOST_GROUPS && group_time_ < LARGEST_GROUP) merge_pairs();  // else each is full
    current_ = (current_ + 1) % MOST_GROUPS;
    full_ = full_ || used_ == MOST_GROUPS;
    used_ = std::min(used_ + 1, MOST_GROUPS);
    groups_[current_].time = 0.0;
  }
  Group& group = groups_[current_];
  if (full_) {
    const double share = std::min(1.0, open_time_ / (MEMORY * group_time_));
    const double known = group.excitation(prior_.scale[STIFFNESS]), news = part.excitation(prior_.scale[STIFFNESS]);
    group.fade(1.0 - share * (news < known ? news / known : 1.0));
  }
  group.add(part);
  group.time += open_time_;
  changed_ = true;
}

// How far the deflection moved in some rows, beside its noise; squares, a row.
double AxisRegression::Part::excitation(double scale) const noexcept {
  const double square = triangle.r[0][0] * triangle.r[0][0] * scale * scale;
  return rows > 0.0 ? std::max(square - noise[OF_ANGLE] - noise[OF_ANGLE_AND_ELEMENT], 0.0) / rows : 0.0;
}

// All of it alike, so that the noise in it fades with it.
void AxisRegression::Part::fade(double left) noexcept {
  triangle.scale(std::sqrt(left));
  for (double& sum : noise) sum *= left;
  rows *= left;
}

void AxisRegression::merge_pairs() noexcept {
  for (int g = 0; g < MOST_GROUPS / 2; ++g) {
    Group pair = groups_[2 * g];
    pair.add(groups_[2 * g + 1]);
    pair.time += groups_[2 * g + 1].time;
    groups_[g] = pair;
  }
  for (int g = MOST_GROUPS / 2; g < MOST_GROUPS; ++g) groups_[g] = {};
  used_ = MOST_GROUPS / 2, current_ = used_ - 1, group_time_ *= 2.0;
}

void AxisRegression::sum_up() noexcept {
  total_ = {};
  for (int g = 0; g < used_; ++g) total_.add(groups_[g]);
}

AxisRegression::Shared AxisRegression::completed(const Part& data) const noexcept {
  Shared whole = data.triangle;
  for (int i = 0; i < UNKNOWNS; ++i) {
    double line[UNKNOWNS + 1] = {};
    line[i] = noise_ / (prior_.spread[i] * prior_.scale[i]);
    line[UNKNOWNS] = line[i] * prior_.mean[i] * prior_.scale[i];
    whole.add(line, i);
  }
  for (Line& line : noise_lines(data)) whole.remove(line.data(), MOST_NOISE);
  return whole;
}

std::array<AxisRegression::Line, NOISE_LINES> AxisRegression::noise_lines(const Part& data) const noexcept {
  std::array<Line, NOISE_LINES> lines;
  const double* sums = data.noise;
  const double load = data.over(BY_LOAD, OF_HORIZONTAL);
  for (int source = 0; source < NOISE_SOURCES; ++source) {
    lines[source] = direction(source, data);
    for (double& part : lines[source]) part *= std::sqrt(sums[source]);
  }
  Line& changes = lines[NOISE_SOURCES] = {};
  const double variance = std::max(sums[BY_LOAD_SQUARED] - load * sums[BY_LOAD], 0.0);
  changes[COMPLIANCE] = std::sqrt(variance) / prior_.scale[COMPLIANCE];
  return lines;
}

// What one unit of a source's noise adds to the columns, and to the torque, in the mean of some rows.
AxisRegression::Line AxisRegression::direction(int source, const Part& data) const noexcept {
  Line along = {};
  switch (source) {
    case OF_ANGLE_AND_ELEMENT:
      along[SLIP_TORQUE] = prior_.element_slope * data.over(ANGLE_BY_ELEMENT, OF_ANGLE_AND_ELEMENT);
      [[fallthrough]];
    case OF_ANGLE:
      along[STIFFNESS] = 1.0;
      break;
    case OF_RATE_AND_ELEMENT:
      along[SLIP_TORQUE] = prior_.element_slope * data.over(RATE_BY_ELEMENT, OF_RATE_AND_ELEMENT);
      [[fallthrough]];
    case OF_RATE:
      along[DAMPING] = along[TURNED] = 1.0;  // of the gyroscope
      break;
    case OF_LOAD:
      along[ASIDE] = 1.0, along[UNKNOWNS] = prior_.load_arm;
      break;
    default:
      along[ABOVE] = 1.0, along[COMPLIANCE] = data.over(BY_LOAD, OF_HORIZONTAL);
      along[UNKNOWNS] = prior_.horizontal_arm;
  }
  for (int i = 0; i < UNKNOWNS; ++i) along[i] /= prior_.scale[i];
  return along;
}

void AxisRegression::solve() noexcept {
  Part data = total_;
  if (open_rows_ >= FEWEST_ROWS) data.add(open_part());
  const double left = data.triangle.r[UNKNOWNS][UNKNOWNS];
  if (data.rows > 2 * UNKNOWNS) noise_ = std::max(left * std::sqrt(COLOUR / (data.rows - UNKNOWNS)), 1e-12);
  double x[UNKNOWNS];
  Shared whole = completed(data);
  whole.solve(x);
  for (int i = 0; i < UNKNOWNS; ++i)
    if (!std::isfinite(x[i])) return;
  for (int i = 0; i < UNKNOWNS; ++i) values_.value[i] = x[i] / prior_.scale[i];
  find_moved();
  // A delay that nobody told is taken for what the others can make of its column.
  double y[UNKNOWNS];
  for (int i = 0; i < UNKNOWNS; ++i) whole.r[i][UNKNOWNS] = i < LATE ? whole.r[i][LATE] : 0.0;
  whole.solve(y);
  for (int i = 0; i < UNKNOWNS; ++i) values_.by_late[i] = y[i] / prior_.scale[i] * prior_.scale[LATE];
  if (open_rows_ >= FEWEST_ROWS && open_.r[0][0] > 0.0) {
    const auto block = pinned();
    double own[OWN];
    for (int e = OWN - 1; e >= 0; --e) {
      double left = block.r[e][BLOCK_UNKNOWNS];
      for (int i = 0; i < UNKNOWNS; ++i) left -= block.r[e][OWN + i] * x[i];
      for (int i = e + 1; i < OWN; ++i) left -= block.r[e][i] * own[i];
      own[e] = block.r[e][e] > 0.0 ? left / block.r[e][e] : 0.0;
    }
    values_.offset = own[OFFSET] + own[SLOPE] * last_time_;
  }
}

void AxisRegression::work() noexcept {
  if (changed_) {
    sum_up();
    changed_ = false, unsure_ = true;
  } else if (unsure_) {
    find_deviations();
    if (used_ >= FEWEST_GROUPS) values_.late = untold(LATE), values_.turned = turns() ? untold(TURNED) : Untold{};
    unsure_ = false;
  } else if (fresh_) {
    solve();
    fresh_ = false;
  }
}

}  // namespace plantar
