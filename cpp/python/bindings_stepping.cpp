#include "bindings.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stepping.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

using Live = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

// Addresses as integers: of the engine's step function, of its model and of its data. The arrays are the data's own.
class SteppingObject {
 public:
  SteppingObject(std::uintptr_t step, std::uintptr_t model, std::uintptr_t data, Live positions, Live applied,
                 Live control, const std::vector<std::array<std::size_t, 2>>& places,
                 const std::vector<std::array<double, 3>>& laws)
      : positions_(std::move(positions)), applied_(std::move(applied)), control_(std::move(control)) {
    if (step == 0 || model == 0 || data == 0) throw std::invalid_argument("an address of nothing");
    if (laws.size() != places.size()) throw std::invalid_argument("every element needs its places and its law");
    std::vector<RubberElement> rubber;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto [angle, torque] = places[k];
      if (angle >= positions_.shape(0) || torque >= applied_.shape(0)) throw std::invalid_argument("no such place");
      rubber.push_back({laws[k][0], laws[k][1], laws[k][2], angle, torque});
    }
    stepping_ = {reinterpret_cast<EngineStep>(step),
                 reinterpret_cast<const void*>(model),
                 reinterpret_cast<void*>(data),
                 positions_.data(),
                 applied_.data(),
                 control_.data(),
                 std::move(rubber)};
  }

  void run(const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& rows) {
    if (rows.shape(1) != control_.shape(0)) throw std::invalid_argument("a row holds every actuator's input");
    nb::gil_scoped_release release;
    stepping_.run(rows.data(), rows.shape(0), rows.shape(1));
  }

 private:
  Live positions_, applied_, control_;
  Stepping stepping_ = {};
};

}  // namespace

void bind_stepping(nb::module_& m) {
  m.attr("STEPPING_SOURCE") = PLANTAR_STEPPING_SOURCE;
  nb::class_<SteppingObject>(m, "Stepping")
      .def(nb::init<std::uintptr_t, std::uintptr_t, std::uintptr_t, Live, Live, Live,
                    const std::vector<std::array<std::size_t, 2>>&, const std::vector<std::array<double, 3>>&>(),
           nb::arg("step"), nb::arg("model"), nb::arg("data"), nb::arg("positions"), nb::arg("applied"),
           nb::arg("control"), nb::arg("places"), nb::arg("laws"))
      .def("run", &SteppingObject::run, nb::arg("rows"));
}
