// Python's views of stepping.hpp and low_pass.hpp, which have files of their own.
#pragma once

#include <nanobind/nanobind.h>

void bind_low_pass(nanobind::module_& m);
void bind_stepping(nanobind::module_& m);
