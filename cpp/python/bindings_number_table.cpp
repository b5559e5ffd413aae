#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "bindings.hpp"
#include "number_table.hpp"

namespace nb = nanobind;
using namespace plantar;

namespace {

// Whole lines of a text into the columns from `first` on of `values` (rows, n), the text's column c into the row
// places[c], or nowhere. How many lines these were; None for a text that is not plain, `values` is then unfinished.
std::optional<std::size_t> numbers_into(const nb::bytes& text, const std::vector<std::ptrdiff_t>& places,
                                        const nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& values,
                                        std::size_t first) {
  const std::size_t rows = values.shape(0), n = values.shape(1);
  if (first > n) throw std::invalid_argument("lines begin inside of the values");
  for (const std::ptrdiff_t place : places)
    if (place != NOWHERE && (place < 0 || static_cast<std::size_t>(place) >= rows))
      throw std::invalid_argument("a place is a row of the values, or -1");
  const std::string_view lines(text.c_str(), text.size());
  double* const begin = values.data() + first;
  nb::gil_scoped_release release;
  const std::ptrdiff_t found = read_numbers(lines, places, begin, n, n - first);
  if (found == NOT_PLAIN) return std::nullopt;
  return static_cast<std::size_t>(found);
}

}  // namespace

void bind_number_table(nb::module_& m) {
  m.def("numbers_into", &numbers_into, nb::arg("text"), nb::arg("places"), nb::arg("values"), nb::arg("first"));
}
