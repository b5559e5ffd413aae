#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "bindings.hpp"
#include "drift.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Series = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

DriftChain chain_of(const Series& weight, const Series& jump, double wander, double period,
                    const std::array<double, 2>& first) {
  if (weight.shape(0) != jump.shape(0)) throw std::invalid_argument("a weight and a jump for each sample");
  return {weight.shape(0), weight.data(), jump.data(), wander, period, {first[0], first[1]}};
}

nb::ndarray<nb::numpy, double> smooth(const Series& weight, const Series& jump, double wander, double period,
                                      const std::array<double, 2>& first, const Rows& values) {
  const DriftChain chain = chain_of(weight, jump, wander, period, first);
  const std::size_t k = values.shape(1);
  if (values.shape(0) != chain.n) throw std::invalid_argument("a row of values for each sample");
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(chain.n * k, 1)]);
  {
    nb::gil_scoped_release release;
    smooth_drift(chain, values.data(), k, data.get());
  }
  return owned(data.release(), {chain.n, k});
}

nb::ndarray<nb::numpy, double> variance(const Series& weight, const Series& jump, double wander, double period,
                                        const std::array<double, 2>& first) {
  const DriftChain chain = chain_of(weight, jump, wander, period, first);
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(chain.n, 1)]);
  {
    nb::gil_scoped_release release;
    drift_variance(chain, data.get());
  }
  return owned(data.release(), {chain.n});
}

}  // namespace

void bind_drift(nb::module_& m) {
  m.def("smooth_drift", &smooth, nb::arg("weight"), nb::arg("jump"), nb::arg("wander"), nb::arg("period"),
        nb::arg("first"), nb::arg("values"));
  m.def("drift_variance", &variance, nb::arg("weight"), nb::arg("jump"), nb::arg("wander"), nb::arg("period"),
        nb::arg("first"));
}
