// The only file that knows Python: arrays in, arrays out, the GIL released while the core works.
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
#include "bindings.hpp"
#include "kernels.hpp"
#include "parallel.hpp"
#include "stream.hpp"

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

// The tree with its own storage, and the arrays of one batch bound to it.
class TreeObject {
 public:
  TreeObject(const std::vector<int>& parents, const std::vector<bool>& slides, const std::vector<Packed>& axes,
             const std::vector<Packed>& frames, bool floating) {
    if (floating) {
      Link root = {};
      root.parent = -1;
      root.joint = Joint::root;
      links_.push_back(root);
    }
    const std::size_t n = parents.size();
    if (slides.size() != n || axes.size() != n || frames.size() != n)
      throw std::invalid_argument("every joint needs a parent, a kind, an axis and a frame");
    for (std::size_t i = 0; i < n; ++i) {
      Link link = {};
      link.parent = parents[i] + (floating ? 1 : 0);
      if (parents[i] < -1 || parents[i] >= static_cast<int>(i)) throw std::invalid_argument("parents come first");
      if (axes[i].shape(0) != 3) throw std::invalid_argument("an axis is three numbers");
      std::copy_n(axes[i].data(), 3, link.axis);
      link.placement = frame(frames[i]);
      const double* r = link.placement.rotation;
      link.turned = !(r[0] == 1.0 && r[4] == 1.0 && r[8] == 1.0);
      link.joint = slides[i]               ? Joint::prismatic
                   : link.axis[0] == 1.0   ? Joint::revolute_x
                   : link.axis[1] == 1.0   ? Joint::revolute_y
                   : link.axis[2] == 1.0   ? Joint::revolute_z
                                           : Joint::revolute;
      links_.push_back(link);
    }
    if (links_.empty()) throw std::invalid_argument("a tree without links");
    tree_ = {links_.data(), static_cast<std::int32_t>(links_.size()), floating};
  }

  TreeObject(const TreeObject& other) : links_(other.links_), tree_(other.tree_) { tree_.links = links_.data(); }
  TreeObject& operator=(const TreeObject&) = delete;

  const Tree& tree() const { return tree_; }
  std::size_t joints() const { return links_.size() - tree_.first_joint(); }

 private:
  std::vector<Link> links_;
  Tree tree_ = {};
};

// base: (N, 9); position, velocity, acceleration: (N, joints). The columns live as long as this object.
struct BoundMotion {
  std::size_t samples;
  std::vector<Column> columns;
  Motion motion = {};

  BoundMotion(const TreeObject& tree, const Matrix& base, const Matrix& q, const Matrix& v, const Matrix& a)
      : samples(base.shape(0)) {
    ::columns(base, samples, motion.base);
    const std::size_t n = tree.joints();
    for (const Matrix* m : {&q, &v, &a}) {
      if (m->shape(0) != samples || m->shape(1) != n) throw std::invalid_argument("an array of the wrong shape");
      for (std::size_t k = 0; k < n; ++k)
        columns.push_back({m->data() + static_cast<std::ptrdiff_t>(k) * m->stride(1), m->stride(0)});
    }
    motion.position = columns.data();
    motion.velocity = columns.data() + n;
    motion.acceleration = columns.data() + 2 * n;
  }
};

std::vector<std::uint32_t> kept_masks(const TreeObject& tree, const std::vector<unsigned>& kept) {
  if (kept.size() != static_cast<std::size_t>(tree.tree().n_links)) throw std::invalid_argument("one mask a link");
  return {kept.begin(), kept.end()};
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
  m.def("instruction_sets", &instruction_sets, "The instruction sets that can run here, the one in use first.");
  m.def("foot_chain", &foot_chain, nb::arg("frames"), nb::arg("slides"), nb::arg("signs"), nb::arg("bush"),
        nb::arg("sole"), nb::arg("positions"), nb::arg("velocities"), nb::arg("orientation"),
        nb::arg("angular_velocity"), nb::arg("threads") = 0, nb::arg("isa") = "");
  nb::class_<TreeObject>(m, "Tree")
      .def(nb::init<const std::vector<int>&, const std::vector<bool>&, const std::vector<Packed>&,
                    const std::vector<Packed>&, bool>(),
           nb::arg("parents"), nb::arg("slides"), nb::arg("axes"), nb::arg("frames"), nb::arg("floating"));
  m.def("regressor", &regressor, nb::arg("tree"), nb::arg("kept"), nb::arg("rows"), nb::arg("base"), nb::arg("q"),
        nb::arg("v"), nb::arg("a"), nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("inverse_dynamics", &inverse_dynamics, nb::arg("tree"), nb::arg("parameters").none(), nb::arg("links"),
        nb::arg("frames"), nb::arg("wrenches"), nb::arg("base"), nb::arg("q"), nb::arg("v"), nb::arg("a"),
        nb::arg("threads") = 0, nb::arg("isa") = "");
  m.def("base_wrenches", &base_wrenches, nb::arg("tree"), nb::arg("parameters"), nb::arg("base"), nb::arg("q"),
        nb::arg("v"), nb::arg("a"), nb::arg("threads") = 0, nb::arg("isa") = "");
  nb::class_<StreamObject>(m, "Stream")
      .def(nb::init<const TreeObject&, const std::vector<unsigned>&, const std::vector<std::size_t>&,
                    const std::vector<std::size_t>&>(),
           nb::arg("tree"), nb::arg("kept"), nb::arg("extras"), nb::arg("groups"))
      .def("add", &StreamObject::add, nb::arg("base"), nb::arg("q"), nb::arg("v"), nb::arg("a"), nb::arg("extras"),
           nb::arg("threads") = 0, nb::arg("isa") = "")
      .def("factor", &StreamObject::factor, nb::arg("group"))
      .def("parameters", &StreamObject::parameters, nb::arg("group"));
  bind_drift(m), bind_estimator(m), bind_factor(m), bind_low_pass(m);
  bind_hysteresis(m), bind_number_table(m), bind_stepping(m);
}
