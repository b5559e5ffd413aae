#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "bindings.hpp"
#include "kernels.hpp"
#include "parallel.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

constexpr std::size_t NUMBERS_PER_THREAD = 100'000;  // half a millisecond's: ten times what starting a thread takes

// values (n, k) through a Butterworth low-pass of fourth order at `cutoff` (a share of the rate), forth and back; every
// nth sample of it.
nb::ndarray<nb::numpy, double> low_pass(
    const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& values, double cutoff,
    std::size_t padding, std::size_t every) {
  const std::size_t n = values.shape(0), k = values.shape(1);
  if (n < 2 || !(cutoff > 0.0 && cutoff < 0.5)) throw std::invalid_argument("two samples and a cutoff below Nyquist's");
  if (every == 0) throw std::invalid_argument("every first sample or fewer");
  const std::size_t kept = (n - 1) / every + 1;
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
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(kept * k, 1)]);
  {
    nb::gil_scoped_release release;
    const std::size_t groups = (k + table.lanes - 1) / table.lanes;
    const std::size_t wanted = std::min<std::size_t>(groups, worthwhile_threads(n * k, NUMBERS_PER_THREAD, 0));
    const unsigned threads = static_cast<unsigned>(std::max<std::size_t>(wanted, 1));
    parallel_parts(k, table.lanes, threads, [&](unsigned, std::size_t begin, std::size_t end) {
      const std::unique_ptr<double[]> work(new double[(n + 2 * padding) * table.lanes]);
      for (std::size_t column = begin; column < end; column += table.lanes)
        table.low_pass(filter, values.data(), n, k, column, work.get(), data.get());
    });
  }
  return owned(data.release(), {kept, k});
}

}  // namespace

void bind_low_pass(nb::module_& m) {
  m.def("low_pass", &low_pass, nb::arg("values"), nb::arg("cutoff"), nb::arg("padding"), nb::arg("every") = 1);
}
