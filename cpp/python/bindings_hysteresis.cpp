#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "bindings.hpp"
#include "branch_curve.hpp"
#include "branched_path.hpp"
#include "relaxation.hpp"
#include "stop_operator.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Pairs = nb::ndarray<const std::int64_t, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using Series = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

Path checked(const Series& deflection, const Pairs& runs, const Rows& start, std::size_t b) {
  const std::size_t n = deflection.shape(0), r = runs.shape(0);
  if (start.shape(0) != r || start.shape(1) != b) throw std::invalid_argument("starts (r, b)");
  std::int64_t before = 0;
  for (std::size_t run = 0; run < r; ++run) {
    const std::int64_t first = runs.data()[2 * run], end = runs.data()[2 * run + 1];
    if (first < before || end <= first || end > static_cast<std::int64_t>(n))
      throw std::invalid_argument("runs of one sample or more, one after the other");
    before = end;
  }
  return {deflection.data(), n, runs.data(), r};
}

template <class Element>
nb::ndarray<nb::numpy, double> walked(const Path& path, std::size_t b, Element element) {
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(path.n * b, 1)]);
  {
    nb::gil_scoped_release release;
    along_path(path, b, element, data.get());
  }
  return owned(data.release(), {path.n, b});
}

nb::ndarray<nb::numpy, double> stop_operator(const Series& deflection, const Pairs& runs, const Series& slip,
                                             const Rows& start) {
  const std::size_t b = slip.shape(0);
  const Path path = checked(deflection, runs, start, b);
  return walked(path, b, StopOperator(slip.data(), start.data(), b));
}

nb::ndarray<nb::numpy, double> branch_curve(const Series& deflection, const Pairs& runs, const Series& pace,
                                            const Rows& start, const Series& place, const Series& state) {
  const std::size_t b = pace.shape(0), m = place.shape(0);
  const Path path = checked(deflection, runs, start, b);
  if (m < 2 || state.shape(0) != m || !std::is_sorted(place.data(), place.data() + m) ||
      !(place.data()[0] < place.data()[m - 1]))
    throw std::invalid_argument("a curve of two places or more, which never fall");
  return walked(path, b, BranchCurve(place.data(), state.data(), m, pace.data(), start.data(), b));
}

nb::ndarray<nb::numpy, double> relaxation(const Series& deflection, const Series& decay, const Series& gain,
                                          const Series& start) {
  const std::size_t n = deflection.shape(0), b = decay.shape(0);
  if (gain.shape(0) != b || start.shape(0) != b) throw std::invalid_argument("decays, gains and starts (b,)");
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * b, 1)]);
  {
    nb::gil_scoped_release release;
    relax(deflection.data(), n, decay.data(), gain.data(), start.data(), b, data.get());
  }
  return owned(data.release(), {n, b});
}

}  // namespace

void bind_hysteresis(nb::module_& m) {
  m.def("stop_operator", &stop_operator, nb::arg("deflection"), nb::arg("runs"), nb::arg("slip"), nb::arg("start"));
  m.def("branch_curve", &branch_curve, nb::arg("deflection"), nb::arg("runs"), nb::arg("pace"), nb::arg("start"),
        nb::arg("place"), nb::arg("state"));
  m.def("relaxation", &relaxation, nb::arg("deflection"), nb::arg("decay"), nb::arg("gain"), nb::arg("start"));
}
