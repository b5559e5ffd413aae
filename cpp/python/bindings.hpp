// What all of the views from Python share, and those that have files of their own: of a floating base, drift.hpp, the
// estimator, factor.hpp, one foot, low_pass.hpp, number_table.hpp, stepping.hpp and stop_operator.hpp.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>

// An array that frees `data`, which `new[]` made, when Python has done with it.
inline nanobind::ndarray<nanobind::numpy, double> owned(double* data, std::initializer_list<std::size_t> shape) {
  nanobind::capsule owner(data, [](void* p) noexcept { delete[] static_cast<double*>(p); });
  return nanobind::ndarray<nanobind::numpy, double>(data, shape, owner);
}

void bind_base(nanobind::module_& m);
void bind_drift(nanobind::module_& m);
void bind_estimator(nanobind::module_& m);
void bind_factor(nanobind::module_& m);
void bind_foot(nanobind::module_& m);
void bind_low_pass(nanobind::module_& m);
void bind_number_table(nanobind::module_& m);
void bind_stepping(nanobind::module_& m);
void bind_stop_operator(nanobind::module_& m);
