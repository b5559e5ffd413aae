// The dynamics seen from Python, and the module itself: arrays in, arrays out, the GIL released while the core works.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "aligned.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "bound_tree.hpp"
#include "parallel.hpp"
#include "stream.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const Kernels* const* table = runnable_kernels(); *table != nullptr; ++table) names.push_back((*table)->name);
  return names;
}

// (rows, columns, N): every row with the columns of every kept parameter; zero where it does not depend on one.
nb::ndarray<nb::numpy, double> regressor(const TreeObject& object, const std::vector<unsigned>& kept,
                                         const std::vector<bool>& wanted, const Matrix& base, const Matrix& q,
                                         const Matrix& v, const Matrix& a, unsigned threads, const std::string& isa) {
  const Tree& tree = object.tree();
  const BoundMotion bound(object, base, q, v, a);
  const std::vector<std::uint32_t> masks = kept_masks(object, kept);
  const std::size_t n = bound.samples, rows = tree.n_rows();
  if (wanted.size() != rows) throw std::invalid_argument("say of each row whether it is wanted");
  std::vector<std::int32_t> first(tree.n_links);
  std::size_t columns = 0;
  for (std::int32_t link = 0; link < tree.n_links; ++link) {
    first[link] = static_cast<std::int32_t>(columns);
    columns += std::popcount(masks[link]);
  }
  const std::size_t count = std::count(wanted.begin(), wanted.end(), true);
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(count * columns * n, 1)]());
  std::vector<RowSink> sinks;
  for (std::size_t row = 0, at = 0; row < rows; ++row)
    sinks.push_back({wanted[row] ? data.get() + at++ * columns * n : nullptr, static_cast<std::ptrdiff_t>(n), first.data()});
  const Kernels& table = kernels(isa);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 512, threads), [&](unsigned, std::size_t begin, std::size_t end) {
      Aligned work = aligned_bytes(table.link_work * tree.n_links);
      table.regressor(tree, bound.motion, masks.data(), sinks.data(), begin, end, begin, work.get());
    });
  }
  return owned(data.release(), {count, columns, n});
}

// (rows, N). contacts: link, frame (12,) and wrench (N, 6) of each.
nb::ndarray<nb::numpy, double> inverse_dynamics(const TreeObject& object, const std::optional<Packed>& parameters,
                                                const std::vector<int>& links, const std::vector<Packed>& frames,
                                                const std::vector<Matrix>& wrenches, const Matrix& base,
                                                const Matrix& q, const Matrix& v, const Matrix& a, unsigned threads,
                                                const std::string& isa) {
  const Tree& tree = object.tree();
  const BoundMotion bound(object, base, q, v, a);
  const std::size_t n = bound.samples, rows = tree.n_rows();
  if (parameters && parameters->shape(0) != static_cast<std::size_t>(PARAMETERS * tree.n_links))
    throw std::invalid_argument("ten parameters a link");
  if (frames.size() != links.size() || wrenches.size() != links.size())
    throw std::invalid_argument("every contact needs a link, a frame and a wrench");
  std::vector<Contact> contacts(links.size());
  for (std::size_t k = 0; k < links.size(); ++k) {
    if (links[k] < 0 || links[k] >= tree.n_links) throw std::invalid_argument("a contact on no link");
    contacts[k].link = links[k];
    contacts[k].frame = frame(frames[k]);
    columns(wrenches[k], n, contacts[k].wrench);
  }
  std::unique_ptr<double[]> data(new double[std::max<std::size_t>(rows * n, 1)]);
  std::vector<double*> out;
  for (std::size_t row = 0; row < rows; ++row) out.push_back(data.get() + row * n);
  const double* given = parameters ? parameters->data() : nullptr;
  const Kernels& table = kernels(isa);
  {
    nb::gil_scoped_release release;
    parallel_parts(n, 64, worthwhile_threads(n, 1024, threads), [&](unsigned, std::size_t begin, std::size_t end) {
      Aligned work = aligned_bytes(table.link_work * tree.n_links);
      table.inverse_dynamics(tree, bound.motion, given, contacts.data(), contacts.size(), begin, end, out.data(),
                             work.get());
    });
  }
  return owned(data.release(), {rows, n});
}

class StreamObject {
 public:
  StreamObject(const TreeObject& tree, const std::vector<unsigned>& kept, const std::vector<std::size_t>& extras,
               const std::vector<std::size_t>& groups)
      : tree_(tree), stream_(tree_.tree(), kept_masks(tree, kept), checked(tree, extras), checked(tree, groups)) {}
  StreamObject(const StreamObject&) = delete;

  void add(const Matrix& base, const Matrix& q, const Matrix& v, const Matrix& a,
           const std::vector<std::vector<Vector>>& extras, unsigned threads, const std::string& isa) {
    const BoundMotion bound(tree_, base, q, v, a);
    if (extras.size() != stream_.rows()) throw std::invalid_argument("extras for each row");
    std::vector<std::vector<Column>> given(extras.size());
    for (std::size_t row = 0; row < extras.size(); ++row) {
      if (extras[row].size() != stream_.layout(row).extras) throw std::invalid_argument("extras of another number");
      for (const Vector& extra : extras[row]) given[row].push_back(column(extra, bound.samples));
    }
    const Kernels& table = kernels(isa);
    nb::gil_scoped_release release;
    stream_.add(table, bound.motion, given, bound.samples, threads);
  }

  nb::ndarray<nb::numpy, double> factor(std::size_t group) const {
    const RowLayout& layout = layout_of(group);
    const std::size_t n = layout.parameters.size() + layout.extras;
    std::unique_ptr<double[]> data(new double[std::max<std::size_t>(n * n, 1)]);
    stream_.factor(group, data.get());
    return owned(data.release(), {n, n});
  }

  std::vector<int> parameters(std::size_t group) const {
    const std::vector<std::int32_t>& found = layout_of(group).parameters;
    return {found.begin(), found.end()};
  }

 private:
  static const std::vector<std::size_t>& checked(const TreeObject& tree, const std::vector<std::size_t>& given) {
    if (given.size() != static_cast<std::size_t>(tree.tree().n_rows()))
      throw std::invalid_argument("a number for each row");
    return given;
  }
  const RowLayout& layout_of(std::size_t group) const {
    if (group >= stream_.groups()) throw std::invalid_argument("no such group of rows");
    return stream_.layout(stream_.first_row(group));
  }

  TreeObject tree_;
  Stream stream_;
};

}  // namespace

NB_MODULE(_core, m) {
  m.doc() = "plantar's native core";
  // An error that ends a program keeps objects alive to its end; people read that one line, not a list of them.
  nb::set_leak_warnings(false);
  m.def("instruction_sets", &instruction_sets, "The instruction sets that can run here, the one in use first.");
  nb::class_<TreeObject>(m, "Tree")
      .def(nb::init<const std::vector<int>&, const std::vector<bool>&, const std::vector<Packed>&,
                    const std::vector<Packed>&, bool>(),
           nb::arg("parents"), nb::arg("slides"), nb::arg("axes"), nb::arg("frames"), nb::arg("floating"));
  m.def("regressor", &regressor, nb::arg("tree"), nb::arg("kept"), nb::arg("rows"), nb::arg("base"), nb::arg("q"),
        nb::arg("v"), nb::arg("a"), nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("inverse_dynamics", &inverse_dynamics, nb::arg("tree"), nb::arg("parameters").none(), nb::arg("links"),
        nb::arg("frames"), nb::arg("wrenches"), nb::arg("base"), nb::arg("q"), nb::arg("v"), nb::arg("a"),
        nb::arg("threads") = 0, nb::arg("isa") = "");
  nb::class_<StreamObject>(m, "Stream")
      .def(nb::init<const TreeObject&, const std::vector<unsigned>&, const std::vector<std::size_t>&,
                    const std::vector<std::size_t>&>(),
           nb::arg("tree"), nb::arg("kept"), nb::arg("extras"), nb::arg("groups"))
      .def("add", &StreamObject::add, nb::arg("base"), nb::arg("q"), nb::arg("v"), nb::arg("a"), nb::arg("extras"),
           nb::arg("threads") = 0, nb::arg("isa") = "")
      .def("factor", &StreamObject::factor, nb::arg("group"))
      .def("parameters", &StreamObject::parameters, nb::arg("group"));
  bind_base(m), bind_drift(m), bind_estimator(m), bind_factor(m), bind_foot(m), bind_hysteresis(m);
  bind_low_pass(m), bind_number_table(m), bind_stepping(m);
}
