// What encoders, IMU and force sensor say of one foot.
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "parallel.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

// (count, N), by work(begin, end, rows) on parts of the samples; at least `least` to a thread.
template <class Work>
nb::ndarray<nb::numpy, double> filled(std::size_t count, std::size_t n, std::size_t least, unsigned threads,
                                      Work work) {
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(count * n, 1)]);
  std::vector<double*> rows;
  for (std::size_t row = 0; row < count; ++row) rows.push_back(data.get() + row * n);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, least, threads),
                   [&](unsigned, std::size_t begin, std::size_t end) { work(begin, end, rows.data()); });
  }
  return owned(data.release(), {count, n});
}

// frames: per step the joint's frame; slides, signs: per step; positions, velocities: per step one column.
nb::ndarray<nb::numpy, double> foot_chain(const std::vector<Packed>& frames, const std::vector<bool>& slides,
                                          const std::vector<double>& signs, const Packed& bush, const Packed& sole,
                                          const std::vector<Vector>& positions, const std::vector<Vector>& velocities,
                                          const Matrix& orientation, const Matrix& angular_velocity, unsigned threads,
                                          const std::string& isa) {
  const std::size_t n = orientation.shape(0), k = frames.size();
  if (slides.size() != k || signs.size() != k || positions.size() != k || velocities.size() != k)
    throw std::invalid_argument("every joint of the path needs a frame, a sign, a position and a velocity");
  std::vector<ChainStep> steps(k);
  for (std::size_t i = 0; i < k; ++i)
    steps[i] = {frame(frames[i]), slides[i], signs[i], column(positions[i], n), column(velocities[i], n)};
  const Chain chain = {steps.data(), k, frame(bush), frame(sole)};
  Attitude attitude;
  columns(orientation, n, attitude.quaternion);
  columns(angular_velocity, n, attitude.angular_velocity);
  const Kernels& table = kernels(isa);
  return filled(CHAIN_OUTPUTS, n, 2048, threads, [&](std::size_t begin, std::size_t end, double* const* rows) {
    table.chain(chain, attitude, begin, end, rows);
  });
}

// (LOAD_OUTPUTS, N): what a force sensor, `wrench` (N, 6) as read, says of a foot whose bush sees `up` (N, 3).
nb::ndarray<nb::numpy, double> sole_load(const Packed& sensor, double sign, const Matrix& wrench, const Matrix& up,
                                         const Packed& sole, double least, unsigned threads, const std::string& isa) {
  const std::size_t n = wrench.shape(0);
  SoleLoad load = {frame(sensor), sign, {}, {}, frame(sole), least};
  columns(wrench, n, load.reading);
  columns(up, n, load.up);
  const Kernels& table = kernels(isa);
  return filled(LOAD_OUTPUTS, n, 8192, threads, [&](std::size_t begin, std::size_t end, double* const* rows) {
    table.sole_load(load, begin, end, rows);
  });
}

}  // namespace

void bind_foot(nb::module_& m) {
  m.def("foot_chain", &foot_chain, nb::arg("frames"), nb::arg("slides"), nb::arg("signs"), nb::arg("bush"),
        nb::arg("sole"), nb::arg("positions"), nb::arg("velocities"), nb::arg("orientation"),
        nb::arg("angular_velocity"), nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("sole_load", &sole_load, nb::arg("sensor"), nb::arg("sign"), nb::arg("wrench"), nb::arg("up"), nb::arg("sole"),
        nb::arg("least"), nb::arg("threads") = 0, nb::arg("isa") = "");
}
