// Lines of numbers, as in a CSV: the plain ones only, what else a text may hold is left to others.
#pragma once

#include <algorithm>
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

// Where the number in digits, or the name of a hole, ends that begins at `at`, before `end`; nullptr for anything else.
inline const char* plain_number(const char* at, const char* end, double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
  if (*at == ',' || *at == '\n' || *at == '\r') return at;
  const std::string_view name(at, std::min<std::size_t>(3, static_cast<std::size_t>(end - at)));
  if (name == "nan" || name == "NaN") return at + name.size();
#ifdef __cpp_lib_to_chars
  const char first = at[*at == '-' && at + 1 < end ? 1 : 0];
  if (first != '.' && (first < '0' || first > '9')) return nullptr;  // infinity has names, too
  const auto [behind, error] = std::from_chars(at, end, value);
  return error == std::errc() ? behind : nullptr;
#else
  return nullptr;
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
      if (at == end) return NOT_PLAIN;
      if (places[column] == NOWHERE) {
        while (at < end && *at != ',' && *at != '\n' && *at != '\r' && *at != '"') ++at;
      } else {
        at = plain_number(at, end, values[static_cast<std::size_t>(places[column]) * stride + line]);
      }
      if (at == nullptr || at == end) return NOT_PLAIN;
      if (column + 1 < places.size() && *at++ != ',') return NOT_PLAIN;
    }
    if (*at == '\r' && ++at == end) return NOT_PLAIN;
    if (*at++ != '\n') return NOT_PLAIN;
    ++line;
  }
  return static_cast<std::ptrdiff_t>(line);
}

}  // namespace plantar
