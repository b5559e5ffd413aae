// The only file that knows Python: arrays in, arrays out, the GIL released while the core works.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels.hpp"
#include "parallel.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Vector = nb::ndarray<const double, nb::ndim<1>, nb::device::cpu>;
using Matrix = nb::ndarray<const double, nb::ndim<2>, nb::device::cpu>;
using Packed = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

const Kernels& kernels(const std::string& isa) {
  const Kernels* const* table = runnable_kernels();
  if (isa.empty()) return **table;
  for (; *table != nullptr; ++table)
    if (isa == (*table)->name) return **table;
  throw std::invalid_argument("this processor or build lacks the instruction set " + isa);
}

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const Kernels* const* table = runnable_kernels(); *table != nullptr; ++table) names.push_back((*table)->name);
  return names;
}

Column column(const Vector& v, std::size_t n) {
  if (v.shape(0) != n) throw std::invalid_argument("columns of different length");
  return {v.data(), v.stride(0)};
}

template <std::size_t K>
void columns(const Matrix& m, std::size_t n, Column (&out)[K]) {
  if (m.shape(0) != n || m.shape(1) != K) throw std::invalid_argument("an array of the wrong shape");
  for (std::size_t k = 0; k < K; ++k) out[k] = {m.data() + static_cast<std::ptrdiff_t>(k) * m.stride(1), m.stride(0)};
}

Frame frame(const Packed& twelve) {
  if (twelve.shape(0) != 12) throw std::invalid_argument("a frame is nine numbers of rotation and three of origin");
  Frame out;
  std::copy_n(twelve.data(), 9, out.rotation);
  std::copy_n(twelve.data() + 9, 3, out.origin);
  return out;
}

nb::ndarray<nb::numpy, double> owned(double* data, std::initializer_list<std::size_t> shape) {
  nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nb::ndarray<nb::numpy, double>(data, shape, owner);
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
  std::unique_ptr<double[]> data(new double[CHAIN_OUTPUTS * std::max<std::size_t>(n, 1)]);
  double* rows[CHAIN_OUTPUTS];
  for (std::size_t r = 0; r < CHAIN_OUTPUTS; ++r) rows[r] = data.get() + r * n;
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 2048, threads),
                   [&](unsigned, std::size_t begin, std::size_t end) { table.chain(chain, attitude, begin, end, rows); });
  }
  return owned(data.release(), {CHAIN_OUTPUTS, n});
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "plantar's native core";
  m.def("instruction_sets", &instruction_sets, "The instruction sets that can run here, the one in use first.");
  m.def("foot_chain", &foot_chain, nb::arg("frames"), nb::arg("slides"), nb::arg("signs"), nb::arg("bush"),
        nb::arg("sole"), nb::arg("positions"), nb::arg("velocities"), nb::arg("orientation"),
        nb::arg("angular_velocity"), nb::arg("threads") = 0, nb::arg("isa") = "");
}
