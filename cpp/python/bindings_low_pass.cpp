#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "kernels.hpp"
#include "parallel.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

constexpr std::size_t NUMBERS_PER_THREAD = 100'000;  // half a millisecond's: ten times what starting a thread takes

// Whether none of the values is NaN or infinite: by several sums, so that none waits for another.
bool all_finite(const double* values, std::size_t count) {
  constexpr std::size_t SUMS = 8;
  double zeros[SUMS] = {};
  std::size_t i = 0;
  for (; i + SUMS <= count; i += SUMS)
    for (std::size_t s = 0; s < SUMS; ++s) zeros[s] += values[i + s] * 0.0;
  for (; i < count; ++i) zeros[0] += values[i] * 0.0;
  double zero = 0.0;
  for (const double each : zeros) zero += each;
  return zero == 0.0;
}

// Where runs of rows without NaN begin and end, of those longer than `shortest`.
std::vector<std::pair<std::size_t, std::size_t>> whole_runs(const double* values, std::size_t n, std::size_t k,
                                                            std::size_t shortest) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  const bool whole = all_finite(values, n * k);
  for (std::size_t row = whole ? n : 0, begin = 0; row <= n; ++row) {
    if (row < n && all_finite(values + row * k, k)) continue;
    if (row - begin > shortest) found.emplace_back(begin, row);
    begin = row + 1;
  }
  return found;
}

// values (n, k) through a Butterworth low-pass of fourth order at `cutoff` (a share of the rate), forth and back, each
// run of rows without NaN by itself; every nth sample of it into `out`. Runs of `shortest` samples or fewer become NaN.
// `out` is the caller's: NumPy's large arrays are on large pages.
void low_pass(const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& values,
              const nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& out, double cutoff,
              std::size_t padding, std::size_t shortest, std::size_t every) {
  const std::size_t n = values.shape(0), k = values.shape(1);
  if (shortest < 1 || !(cutoff > 0.0 && cutoff < 0.5))
    throw std::invalid_argument("runs of two samples and a cutoff below Nyquist's");
  if (every == 0) throw std::invalid_argument("every first sample or fewer");
  const std::size_t kept = (n + every - 1) / every;
  if (out.shape(0) != kept || out.shape(1) != k) throw std::invalid_argument("out is not as large as what is kept");
  LowPass filter;
  filter.every = every;
  filter.padding = padding;
  const double warped = std::tan(std::numbers::pi * cutoff);
  for (int pair = 0; pair < 2; ++pair) {
    const double damping = 2.0 * std::cos(std::numbers::pi * (1 + 2 * pair) / 8.0);
    const double norm = 1.0 / (1.0 + damping * warped + warped * warped);
    filter.sections[pair] = {warped * warped * norm, 2.0 * (warped * warped - 1.0) * norm,
                             (1.0 - damping * warped + warped * warped) * norm};
  }
  const Kernels& table = **runnable_kernels();
  nb::gil_scoped_release release;
  const double *const begin = values.data(), *const end = begin + n * k;
  const auto runs = whole_runs(begin, n, k, shortest);
  std::size_t covered = 0, longest = 0;
  for (const auto& [first, last] : runs) covered += last - first, longest = std::max(longest, last - first);
  if (covered < n) std::fill_n(out.data(), kept * k, std::numeric_limits<double>::quiet_NaN());
  const std::size_t groups = (k + table.lanes - 1) / table.lanes;
  const std::size_t wanted = std::min<std::size_t>(groups, worthwhile_threads(covered * k, NUMBERS_PER_THREAD, 0));
  const unsigned threads = static_cast<unsigned>(std::max<std::size_t>(wanted, 1));
  parallel_parts(k, table.lanes, threads, [&](unsigned, std::size_t from, std::size_t to) {
    const std::unique_ptr<double[]> work(new double[low_pass_work(longest, padding, table.lanes)]);
    for (const auto& [first, last] : runs) {
      const std::size_t row = (first + every - 1) / every;  // of the first that is kept
      const Rows rows = {begin + first * k, end, last - first, k, row * every - first};
      table.low_pass(filter, rows, from, to, work.get(), out.data() + row * k);
    }
  });
}

}  // namespace

void bind_low_pass(nb::module_& m) {
  m.def("low_pass", &low_pass, nb::arg("values"), nb::arg("out"), nb::arg("cutoff"), nb::arg("padding"),
        nb::arg("shortest"), nb::arg("every") = 1);
}
