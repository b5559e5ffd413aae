// Python's views of drift.hpp, the estimator, factor.hpp, low_pass.hpp, stepping.hpp and stop_operator.hpp, which have
// files of their own.
#pragma once

#include <nanobind/nanobind.h>

void bind_drift(nanobind::module_& m);
void bind_estimator(nanobind::module_& m);
void bind_factor(nanobind::module_& m);
void bind_low_pass(nanobind::module_& m);
void bind_stepping(nanobind::module_& m);
void bind_stop_operator(nanobind::module_& m);
