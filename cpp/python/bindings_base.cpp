// What one frame or the whole tree tells of a floating base, seen from Python.
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "aligned.hpp"
#include "bindings.hpp"
#include "bound_tree.hpp"
#include "parallel.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

// (sets, N, 6) of a floating base; parameters: (sets, 10 links).
nb::ndarray<nb::numpy, double> base_wrenches(
    const TreeObject& object, const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& parameters,
    const Matrix& base, const Matrix& q, const Matrix& v, const Matrix& a, unsigned threads, const std::string& isa) {
  const Tree& tree = object.tree();
  const BoundMotion bound(object, base, q, v, a);
  const std::size_t n = bound.samples, sets = parameters.shape(0);
  if (!tree.floating) throw std::invalid_argument("a floating base");
  if (parameters.shape(1) != static_cast<std::size_t>(PARAMETERS * tree.n_links))
    throw std::invalid_argument("ten parameters a link");
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(sets * n * BASE_ROWS, 1)]);
  const Kernels& table = kernels(isa);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 512, threads), [&](unsigned, std::size_t begin, std::size_t end) {
      Aligned work = aligned_bytes(table.link_work * tree.n_links);
      table.base_wrenches(tree, bound.motion, parameters.data(), sets, begin, end, n, data.get(), work.get());
    });
  }
  return owned(data.release(), {sets, n, static_cast<std::size_t>(BASE_ROWS)});
}

// A frame (12,) on a link, with its path from the root.
struct BoundFrame {
  std::vector<std::int32_t> path;
  Carried carried;

  BoundFrame(const TreeObject& object, int link, const Packed& twelve) : carried{nullptr, 0, frame(twelve)} {
    const Tree& tree = object.tree();
    if (link < -1 || link >= tree.n_links) throw std::invalid_argument("a frame on no link");
    for (std::int32_t i = link; i >= tree.first_joint(); i = tree.links[i].parent) path.push_back(i);
    std::reverse(path.begin(), path.end());
    carried.path = path.data();
    carried.n_path = path.size();
  }
};

// (N, 9) from an IMU's, `measured` (N, 9), whose `place` (12,) is in a link.
nb::ndarray<nb::numpy, double> root_motion(const TreeObject& object, int link, const Packed& place,
                                           const Matrix& measured, const Matrix& q, const Matrix& v, const Matrix& a,
                                           unsigned threads, const std::string& isa) {
  const BoundFrame imu(object, link, place);
  const BoundMotion bound(object, measured, q, v, a);
  const std::size_t n = bound.samples;
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * 9, 1)]);
  const Kernels& table = kernels(isa);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 4096, threads), [&](unsigned, std::size_t begin, std::size_t end) {
      table.root_motion(object.tree(), imu.carried, bound.motion, bound.motion.base, begin, end, data.get());
    });
  }
  return owned(data.release(), {n, 9});
}

// (N, 6, 6) of a contact whose `place` (12,) is in a link; positions: (N, joints).
nb::ndarray<nb::numpy, double> base_transfer(const TreeObject& object, int link, const Packed& place,
                                             const Matrix& positions, unsigned threads, const std::string& isa) {
  const BoundFrame contact(object, link, place);
  const std::size_t n = positions.shape(0), joints = object.joints();
  if (positions.shape(1) != joints) throw std::invalid_argument("an array of the wrong shape");
  std::vector<Column> columns;
  for (std::size_t k = 0; k < joints; ++k)
    columns.push_back({positions.data() + static_cast<std::ptrdiff_t>(k) * positions.stride(1), positions.stride(0)});
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * 36, 1)]);
  const Kernels& table = kernels(isa);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 4096, threads), [&](unsigned, std::size_t begin, std::size_t end) {
      table.base_transfer(object.tree(), contact.carried, columns.data(), begin, end, data.get());
    });
  }
  return owned(data.release(), {n, 6, 6});
}

}  // namespace

void bind_base(nb::module_& m) {
  m.def("base_wrenches", &base_wrenches, nb::arg("tree"), nb::arg("parameters"), nb::arg("base"), nb::arg("q"),
        nb::arg("v"), nb::arg("a"), nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("root_motion", &root_motion, nb::arg("tree"), nb::arg("link"), nb::arg("place"), nb::arg("measured"),
        nb::arg("q"), nb::arg("v"), nb::arg("a"), nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("base_transfer", &base_transfer, nb::arg("tree"), nb::arg("link"), nb::arg("place"), nb::arg("positions"),
        nb::arg("threads") = 0, nb::arg("isa") = "");
}
