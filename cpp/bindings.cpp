// The only file that knows Python: arrays in, arrays out, the GIL released while the core works.
#include <nanobind/nanobind.h>

NB_MODULE(_core, m) { m.doc() = "plantar's native core"; }
