// Python's view of stepping.hpp.
#pragma once

#include <nanobind/nanobind.h>

void bind_stepping(nanobind::module_& m);
