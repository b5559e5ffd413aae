// A zero-phase low-pass along rows of (n, k), one column a lane: Butterworth of fourth order, run forth and back.
#pragma once

#include "lanes.hpp"
#include "low_pass.hpp"
#include "pack.hpp"

namespace plantar::PLANTAR_ISA {

struct SectionState {
  Lanes first, second;
};

// The state in which a section answers to a signal that was always `x` with just that.
PLANTAR_INLINE SectionState settled(const Section& section, Lanes x) {
  return {(1.0 - section.b) * x, (section.b - section.a2) * x};
}

PLANTAR_INLINE Lanes advance(const Section& section, SectionState& state, Lanes x) {
  const Lanes y = section.b * x + state.first;
  state.first = (2.0 * section.b * x + state.second) - section.a1 * y;  // y is last: all waits for it
  state.second = section.b * x - section.a2 * y;
  return y;
}

PLANTAR_INLINE void keep(double* at, const SectionState& state) {
  store(at, state.first);
  store(at + LANES, state.second);
}

PLANTAR_INLINE SectionState kept(const double* at) { return {load(at), load(at + LANES)}; }

// Columns [column, column + LANES) of the signal; `work` holds LANES doubles for each of `low_pass_work` rows. `out` has a
// row for each sample that is kept.
//
// Of a long signal only the states at the beginnings of blocks are kept on the way forth, and each block is filtered
// again on the way back: it stays near the processor, where all of it would go through memory four times.
inline void low_pass(const LowPass& filter, const Rows& rows, std::size_t column, double* work, double* out) {
  const std::size_t count = rows.k - column < LANES ? rows.k - column : LANES;
  // Lanes beyond the last column take what stands there, and are dropped at the end.
  const auto read = [&](std::size_t row) {
    const double* from = rows.values + row * rows.k + column;
    if (rows.end - from >= LANES) return load(from);
    Lanes x = Lanes{};
    for (std::size_t l = 0; l < count; ++l) x[l] = from[l];
    return x;
  };
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(rows.n) - 1, padding = static_cast<std::ptrdiff_t>(filter.padding);
  const Lanes rise = 2.0 * (read(last) - read(0));
  // Beyond both ends the signal goes on point-symmetrically, again and again.
  const auto at = [&](std::ptrdiff_t place) {
    if (place < 0 && place >= -last) return 2.0 * read(0) - read(-place);
    if (place > last && place <= 2 * last) return 2.0 * read(last) - read(2 * last - place);
    std::ptrdiff_t turns = place / (2 * last), rest = place % (2 * last);
    if (rest < 0) {
      rest += 2 * last;
      --turns;
    }
    const Lanes x = rest <= last ? read(rest) : 2.0 * read(last) - read(2 * last - rest);
    return x + static_cast<double>(turns) * rise;
  };
  const Section &one = filter.sections[0], &two = filter.sections[1];
  Lanes x = at(-padding);
  SectionState first = settled(one, x), second = settled(two, x);
  const auto forth = [&](std::ptrdiff_t from, std::ptrdiff_t to, bool stored) {
    for (std::ptrdiff_t i = from; i < to; ++i) {
      x = advance(two, second, advance(one, first, i < 0 || i > last ? at(i) : read(i)));
      if (stored) store(work + (i - from) * LANES, x);
    }
  };
  constexpr std::ptrdiff_t block = LOW_PASS_BLOCK;
  const std::ptrdiff_t end = last + 1 + padding, blocks = (end + padding + block - 1) / block;
  double* const states = work + block * LANES;
  for (std::ptrdiff_t b = 0; b < blocks; ++b) {
    keep(states + 4 * b * LANES, first), keep(states + (4 * b + 2) * LANES, second);
    forth(b * block - padding, b + 1 < blocks ? (b + 1) * block - padding : end, b + 1 == blocks);
  }
  SectionState back = settled(one, x), again = settled(two, x);
  const std::ptrdiff_t every = static_cast<std::ptrdiff_t>(filter.every), begin = static_cast<std::ptrdiff_t>(rows.first);
  std::ptrdiff_t row = last < begin ? -1 : (last - begin) / every;  // of the next sample to keep
  for (std::ptrdiff_t b = blocks - 1; b >= 0; --b) {
    const std::ptrdiff_t from = b * block - padding, to = b + 1 < blocks ? from + block : end;
    if (to <= begin) break;
    if (b + 1 < blocks) {
      first = kept(states + 4 * b * LANES), second = kept(states + (4 * b + 2) * LANES);
      forth(from, to, true);
    }
    for (std::ptrdiff_t i = to - 1; i >= (from > begin ? from : begin); --i) {
      const Lanes y = advance(two, again, advance(one, back, load(work + (i - from) * LANES)));
      if (i == begin + row * every) scatter(out + row-- * rows.k + column, y, count);
    }
  }
}

}  // namespace plantar::PLANTAR_ISA
