#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "bindings.hpp"
#include "factor.hpp"
#include "kernels.hpp"
#include "triangular.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

// R of all factors' rows, each times its weight: upper (n, n). onto[k]: where the factor's columns stand, increasing.
nb::ndarray<nb::numpy, double> stacked(
    const std::vector<nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>>& factors,
    const std::vector<std::vector<int>>& onto, const std::vector<double>& weights, std::size_t n) {
  Factor all(n);
  if (onto.size() != factors.size() || weights.size() != factors.size())
    throw std::invalid_argument("every factor needs its columns and its weight");
  const Kernels& table = **runnable_kernels();
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const std::size_t size = factors[k].shape(0);
    const std::vector<std::int32_t> columns(onto[k].begin(), onto[k].end());
    const bool valid = factors[k].shape(1) == size && columns.size() == size &&
                       std::adjacent_find(columns.begin(), columns.end(), std::greater_equal<>()) == columns.end() &&
                       (columns.empty() || (columns.front() >= 0 && columns.back() < static_cast<int>(n)));
    if (!valid) throw std::invalid_argument("a factor's columns must increase and be as many as its own");
    nb::gil_scoped_release release;
    all.take(table, factors[k].data(), size, columns.data(), weights[k]);
  }
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * n, 1)]);
  all.copy_upper(data.get());
  return owned(data.release(), {n, n});
}

nb::ndarray<nb::numpy, double> inverse_upper(
    const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& upper) {
  const std::size_t n = upper.shape(0);
  if (upper.shape(1) != n) throw std::invalid_argument("a square matrix");
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * n, 1)]);
  {
    nb::gil_scoped_release release;
    invert_upper(upper.data(), data.get(), n);
  }
  return owned(data.release(), {n, n});
}

}  // namespace

void bind_factor(nb::module_& m) {
  m.def("stacked", &stacked, nb::arg("factors"), nb::arg("onto"), nb::arg("weights"), nb::arg("n"));
  m.def("inverse_upper", &inverse_upper, nb::arg("upper"));
}
