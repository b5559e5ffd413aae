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

// LANES columns of a signal from `column` on, point-symmetrically continued beyond both ends, again and again.
struct Columns {
  const Rows& rows;
  std::size_t column;
  std::ptrdiff_t last;

  // Lanes beyond the last column take what stands there, and are dropped at the end.
  PLANTAR_INLINE Lanes read(std::ptrdiff_t row) const {
    const double* from = rows.values + static_cast<std::size_t>(row) * rows.k + column;
    if (rows.end - from >= LANES) return load(from);
    Lanes x = Lanes{};
    for (std::ptrdiff_t l = 0; l < rows.end - from; ++l) x[l] = from[l];
    return x;
  }

  Lanes beyond(std::ptrdiff_t place) const {
    if (place < 0 && place >= -last) return 2.0 * read(0) - read(-place);
    if (place > last && place <= 2 * last) return 2.0 * read(last) - read(2 * last - place);
    std::ptrdiff_t turns = place / (2 * last), rest = place % (2 * last);
    if (rest < 0) {
      rest += 2 * last;
      --turns;
    }
    const Lanes x = rest <= last ? read(rest) : 2.0 * read(last) - read(2 * last - rest);
    return x + static_cast<double>(turns) * (2.0 * (read(last) - read(0)));
  }
};

// Columns [column, to) of the signal, LANES at a time; `work` holds `low_pass_work` doubles. `out` has a row for each
// sample that is kept.
//
// On the way forth only the states at the beginnings of blocks are kept, and each block is filtered again on the way
// back, all columns of one before the next: so it stays near the processor, where all of a long or a wide signal would
// go through memory for every LANES of its columns.
inline void low_pass(const LowPass& filter, const Rows& rows, std::size_t column, std::size_t to, double* work,
                     double* out) {
  const Section &one = filter.sections[0], &two = filter.sections[1];
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(rows.n) - 1,
                       padding = static_cast<std::ptrdiff_t>(filter.padding),
                       every = static_cast<std::ptrdiff_t>(filter.every),
                       begin = static_cast<std::ptrdiff_t>(rows.first),
                       block = static_cast<std::ptrdiff_t>(low_pass_block(rows.k)), end = last + 1 + padding,
                       blocks = (end + padding + block - 1) / block;
  const std::size_t groups = (to - column + LANES - 1) / LANES;
  const auto states = [&](std::ptrdiff_t b, std::size_t group) {
    return work + 4 * (static_cast<std::size_t>(b) * groups + group) * LANES;
  };
  double* const filtered = states(blocks + 1, 0);
  SectionState first, second;
  const auto forth = [&](const Columns& signal, std::ptrdiff_t b, bool stored) {
    const std::ptrdiff_t from = b * block - padding, until = b + 1 < blocks ? from + block : end;
    Lanes x = Lanes{};
    for (std::ptrdiff_t i = from; i < until; ++i) {
      x = i < 0 || i > last ? signal.beyond(i) : signal.read(i);
      x = advance(two, second, advance(one, first, x));
      if (stored) store(filtered + (i - from) * LANES, x);
    }
    return x;
  };
  for (std::ptrdiff_t b = 0; b < blocks; ++b) {
    for (std::size_t group = 0; group < groups; ++group) {
      const Columns signal = {rows, column + group * LANES, last};
      if (b == 0) {
        const Lanes x = signal.beyond(-padding);
        first = settled(one, x), second = settled(two, x);
        keep(states(0, group), first), keep(states(0, group) + 2 * LANES, second);
      }
      if (b + 1 == blocks) continue;
      first = kept(states(b, group)), second = kept(states(b, group) + 2 * LANES);
      forth(signal, b, false);
      keep(states(b + 1, group), first), keep(states(b + 1, group) + 2 * LANES, second);
    }
  }
  for (std::ptrdiff_t b = blocks - 1; b >= 0; --b) {
    const std::ptrdiff_t from = b * block - padding, until = b + 1 < blocks ? from + block : end;
    if (until <= begin) break;
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t place = column + group * LANES, count = to - place < LANES ? to - place : LANES;
      double* const after = states(b + 1, group);  // the way back begins where that of the block behind ended
      first = kept(states(b, group)), second = kept(states(b, group) + 2 * LANES);
      const Lanes x = forth({rows, place, last}, b, true);
      if (b + 1 == blocks) {
        first = settled(one, x), second = settled(two, x);
      } else {
        first = kept(after), second = kept(after + 2 * LANES);
      }
      std::ptrdiff_t row = until <= begin ? -1 : ((until - 1 < last ? until - 1 : last) - begin) / every;
      for (std::ptrdiff_t i = until - 1; i >= (from > begin ? from : begin); --i) {
        const Lanes y = advance(two, second, advance(one, first, load(filtered + (i - from) * LANES)));
        if (i == begin + row * every) scatter(out + row-- * rows.k + place, y, count);
      }
      keep(states(b, group), first), keep(states(b, group) + 2 * LANES, second);
    }
  }
}

}  // namespace plantar::PLANTAR_ISA
