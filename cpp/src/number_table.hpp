// Lines of numbers, as in a CSV: the plain ones only, what else a text may hold is left to others.
#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

namespace plantar {

// Where a column of the text goes: a row of the result, or nowhere.
constexpr std::ptrdiff_t NOWHERE = -1;
constexpr std::ptrdiff_t NOT_PLAIN = -1;

// Whether a cell is a number in digits, or one of the names of a hole.
inline bool plain_number(std::string_view cell, double& value) {
  if (cell.empty() || cell == "nan" || cell == "NaN") {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
#ifdef __cpp_lib_to_chars
  const char first = cell[cell.size() > 1 && cell[0] == '-' ? 1 : 0];
  if (first != '.' && (first < '0' || first > '9')) return false;  // infinity has names, too
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
#else
  return false;
#endif
}

// Whole lines of `places.size()` cells each into rows of `values`: column c of line n goes to
// values[places[c] * stride + n], of at most `most` lines. The number of lines; NOT_PLAIN for a text with anything but
// numbers where one is wanted, quotes, lines of another length or none, or more lines than that.
inline std::ptrdiff_t read_numbers(std::string_view text, const std::vector<std::ptrdiff_t>& places, double* values,
                                   std::size_t stride, std::size_t most) {
  const char *at = text.data(), *const end = at + text.size();
  std::size_t line = 0;
  while (at < end) {
    if (line == most || *at == '\n' || *at == '\r') return NOT_PLAIN;
    for (std::size_t column = 0; column < places.size(); ++column) {
      const char* const begin = at;
      while (at < end && *at != ',' && *at != '\n' && *at != '\r' && *at != '"') ++at;
      if (at == end || *at == '"' || (*at == ',') != (column + 1 < places.size())) return NOT_PLAIN;
      if (places[column] != NOWHERE) {
        double& value = values[static_cast<std::size_t>(places[column]) * stride + line];
        if (!plain_number({begin, static_cast<std::size_t>(at - begin)}, value)) return NOT_PLAIN;
      }
      if (*at == ',') ++at;
    }
    if (*at == '\r' && (++at == end || *at != '\n')) return NOT_PLAIN;
    ++at;
    ++line;
  }
  return static_cast<std::ptrdiff_t>(line);
}

}  // namespace plantar
