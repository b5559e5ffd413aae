// Python's view of the estimator: one tick, or a whole log with the time that each tick takes.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <chrono>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "bindings.hpp"
#include "plantar/foot_estimator.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Vector = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Matrix = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Cube = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Rows = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Out = nb::ndarray<double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Series = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// Of one foot, in the order of `plantar.online.estimator.FIELDS`.
constexpr std::size_t AXIS_FIELDS = 14, FIELDS = 9 + 2 * AXIS_FIELDS;

void write(const FootEstimate& foot, double* to) {
  *to++ = static_cast<double>(foot.contact);
  *to++ = foot.load;
  *to++ = foot.centre_of_pressure[0];
  *to++ = foot.centre_of_pressure[1];
  *to++ = static_cast<double>(foot.flags);
  *to++ = foot.compression;
  *to++ = foot.compliance.value;
  *to++ = foot.compliance.std;
  *to++ = foot.compliance.half_width;
  for (const AxisEstimate* axis : {&foot.pitch, &foot.roll}) {
    *to++ = axis->deflection;
    *to++ = axis->rate;
    *to++ = axis->torque;
    for (const Parameter* one : {&axis->stiffness, &axis->damping, &axis->slip_torque}) {
      *to++ = one->value;
      *to++ = one->std;
      *to++ = one->half_width;
    }
    *to++ = axis->offset;
    *to++ = axis->identified ? 1.0 : 0.0;
  }
}

class EstimatorObject {
 public:
  explicit EstimatorObject(const std::string& text) : model_(parsed(text)), estimator_(model_) {}

  void step(double time, const Vector& position, const std::optional<Vector>& velocity,
            const std::optional<Vector>& attitude, const std::optional<Vector>& angular_velocity,
            const std::optional<Vector>& acceleration, const Matrix& wrench, const Rows& out) {
    if (wrench.shape(0) != model_.feet.size() || wrench.shape(1) != 6) throw std::invalid_argument("a wrench a foot");
    if (out.shape(0) != model_.feet.size() || out.shape(1) != FIELDS) throw std::invalid_argument("a row a foot");
    const auto some = [](const std::optional<Vector>& v) {
      return v ? std::span<const double>(v->data(), v->shape(0)) : std::span<const double>();
    };
    const auto* wrenches = reinterpret_cast<const std::array<double, 6>*>(wrench.data());
    const auto found = estimator_.step({time,
                                        {position.data(), position.shape(0)},
                                        some(velocity),
                                        some(attitude),
                                        some(angular_velocity),
                                        some(acceleration),
                                        {wrenches, wrench.shape(0)}});
    for (std::size_t f = 0; f < found.size(); ++f) write(found[f], out.data() + f * FIELDS);
  }

  // wrench: (N, feet, 6); out: (N, feet, FIELDS); latency: (N) [s].
  void replay(const Vector& time, const Matrix& position, const std::optional<Matrix>& velocity,
              const std::optional<Matrix>& attitude, const std::optional<Matrix>& angular_velocity,
              const std::optional<Matrix>& acceleration, const Cube& wrench, const Out& out, const Series& latency) {
    const std::size_t n = time.shape(0), feet = model_.feet.size();
    const auto same = [n](const std::optional<Matrix>& m) { return !m || m->shape(0) == n; };
    if (position.shape(0) != n || wrench.shape(0) != n || wrench.shape(1) != feet || wrench.shape(2) != 6 ||
        out.shape(0) != n || out.shape(1) != feet || out.shape(2) != FIELDS || latency.shape(0) != n ||
        !same(velocity) || !same(attitude) || !same(angular_velocity) || !same(acceleration))
      throw std::invalid_argument("arrays of different length");
    const auto row = [](const std::optional<Matrix>& m, std::size_t i) {
      return m ? std::span<const double>(m->data() + i * m->shape(1), m->shape(1)) : std::span<const double>();
    };
    nb::gil_scoped_release release;
    for (std::size_t i = 0; i < n; ++i) {
      const auto* wrenches = reinterpret_cast<const std::array<double, 6>*>(wrench.data() + 6 * feet * i);
      const Reading reading = {time.data()[i],           {position.data() + i * position.shape(1), position.shape(1)},
                               row(velocity, i),         row(attitude, i),
                               row(angular_velocity, i), row(acceleration, i),
                               {wrenches, feet}};
      const auto begun = std::chrono::steady_clock::now();
      const auto found = estimator_.step(reading);
      latency.data()[i] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      for (std::size_t f = 0; f < feet; ++f) write(found[f], out.data() + (i * feet + f) * FIELDS);
    }
  }

 private:
  static EstimatorModel parsed(const std::string& text) {
    std::istringstream stream(text);
    return read_model(stream);
  }

  EstimatorModel model_;
  FootEstimator estimator_;
};

}  // namespace

void bind_estimator(nb::module_& m) {
  nb::class_<EstimatorObject>(m, "FootEstimator")
      .def(nb::init<const std::string&>(), nb::arg("model"))
      .def("step", &EstimatorObject::step, nb::arg("time"), nb::arg("position"), nb::arg("velocity").none(),
           nb::arg("attitude").none(), nb::arg("angular_velocity").none(), nb::arg("acceleration").none(),
           nb::arg("wrench"), nb::arg("out"))
      .def("replay", &EstimatorObject::replay, nb::arg("time"), nb::arg("position"), nb::arg("velocity").none(),
           nb::arg("attitude").none(), nb::arg("angular_velocity").none(), nb::arg("acceleration").none(),
           nb::arg("wrench"), nb::arg("out"), nb::arg("latency"));
}
