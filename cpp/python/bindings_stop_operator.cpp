#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "bindings.hpp"
#include "stop_operator.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const std::int64_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Series = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

nb::ndarray<nb::numpy, double> states(const Rows& direction, const Rows& length, const Numbers& branch,
                                      const Rows& travelled, const Series& slip, const Rows& start) {
  const std::size_t turns = direction.shape(0), runs = direction.shape(1), n = branch.shape(0), b = slip.shape(0);
  if (length.shape(0) != turns || length.shape(1) != runs || branch.shape(1) != runs || travelled.shape(0) != n ||
      travelled.shape(1) != runs || start.shape(0) != runs || start.shape(1) != b || turns == 0)
    throw std::invalid_argument("directions and lengths (T, r), branches and ways (n, r), starts (r, b)");
  const auto [least, most] = std::minmax_element(branch.data(), branch.data() + n * runs);
  if (n > 0 && runs > 0 && (*least < 0 || *most >= static_cast<std::int64_t>(turns)))
    throw std::invalid_argument("a sample of a branch that is not there");
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * runs * b, 1)]);
  {
    nb::gil_scoped_release release;
    stop_operator({turns, runs, n, direction.data(), length.data(), branch.data(), travelled.data()}, slip.data(),
                  start.data(), b, data.get());
  }
  return owned(data.release(), {n, runs, b});
}

}  // namespace

void bind_stop_operator(nb::module_& m) {
  m.def("stop_operator", &states, nb::arg("direction"), nb::arg("length"), nb::arg("branch"), nb::arg("travelled"),
        nb::arg("slip"), nb::arg("start"));
}
