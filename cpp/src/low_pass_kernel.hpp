// A zero-phase low-pass along rows of (n, k), one column a lane: Butterworth of fourth order, run forth and back.
//
// Each sample waits for the one before it. So several vectors of columns go through together, and the processor works
// on one while the others wait.
#pragma once

#include "lanes.hpp"
#include "low_pass.hpp"
#include "pack.hpp"

namespace plantar::PLANTAR_ISA {

template <int V>
struct Wide {
  static constexpr std::size_t SIZE = static_cast<std::size_t>(V) * LANES;
  Lanes part[V];
};

template <int V>
PLANTAR_INLINE Wide<V> operator+(Wide<V> a, const Wide<V>& b) {
  for (int i = 0; i < V; ++i) a.part[i] += b.part[i];
  return a;
}
template <int V>
PLANTAR_INLINE Wide<V> operator-(Wide<V> a, const Wide<V>& b) {
  for (int i = 0; i < V; ++i) a.part[i] -= b.part[i];
  return a;
}
template <int V>
PLANTAR_INLINE Wide<V> operator*(double k, Wide<V> a) {
  for (int i = 0; i < V; ++i) a.part[i] *= k;
  return a;
}
template <int V>
PLANTAR_INLINE Wide<V> load_wide(const double* p) {
  Wide<V> x;
  for (int i = 0; i < V; ++i) x.part[i] = load(p + i * LANES);
  return x;
}
template <int V>
PLANTAR_INLINE void store(double* p, const Wide<V>& x) {
  for (int i = 0; i < V; ++i) store(p + i * LANES, x.part[i]);
}

template <int V>
struct SectionState {
  Wide<V> first, second;
};

// The state in which a section answers to a signal that was always `x` with just that.
template <int V>
PLANTAR_INLINE SectionState<V> settled(const Section& section, Wide<V> x) {
  return {(1.0 - section.b) * x, (section.b - section.a2) * x};
}

template <int V>
PLANTAR_INLINE Wide<V> advance(const Section& section, SectionState<V>& state, Wide<V> x) {
  const Wide<V> y = section.b * x + state.first;
  state.first = (2.0 * section.b * x + state.second) - section.a1 * y;  // y is last: all waits for it
  state.second = section.b * x - section.a2 * y;
  return y;
}

template <int V>
PLANTAR_INLINE void keep(double* at, const SectionState<V>& state) {
  store(at, state.first);
  store(at + Wide<V>::SIZE, state.second);
}

template <int V>
PLANTAR_INLINE SectionState<V> kept(const double* at) {
  return {load_wide<V>(at), load_wide<V>(at + Wide<V>::SIZE)};
}

// V * LANES columns of a signal from `column` on, point-symmetrically continued beyond both ends, again and again.
template <int V>
struct Columns {
  const Rows& rows;
  std::size_t column;
  std::ptrdiff_t last;

  // Lanes beyond the last column take what stands there, and are dropped at the end.
  PLANTAR_INLINE Wide<V> read(std::ptrdiff_t row) const {
    const double* from = rows.values + static_cast<std::size_t>(row) * rows.k + column;
    const std::ptrdiff_t there = rows.end - from;
    if (there >= V * LANES) return load_wide<V>(from);
    Wide<V> x = {};
    for (std::ptrdiff_t l = 0; l < there; ++l) x.part[l / LANES][l % LANES] = from[l];
    return x;
  }

  PLANTAR_INLINE Wide<V> at(std::ptrdiff_t place) const {
    if (place >= 0 && place <= last) return read(place);
    if (place < 0 && place >= -last) return 2.0 * read(0) - read(-place);
    if (place > last && place <= 2 * last) return 2.0 * read(last) - read(2 * last - place);
    return far_beyond(place);
  }

  Wide<V> far_beyond(std::ptrdiff_t place) const {
    std::ptrdiff_t turns = place / (2 * last), rest = place % (2 * last);
    if (rest < 0) {
      rest += 2 * last;
      --turns;
    }
    const Wide<V> x = rest <= last ? read(rest) : 2.0 * read(last) - read(2 * last - rest);
    return x + static_cast<double>(turns) * (2.0 * (read(last) - read(0)));
  }
};

// V vectors of columns from `column` on, those before `to`; `work` holds `low_pass_work` doubles. `out` has a row for
// each sample that is kept.
//
// On the way forth only the states at the beginnings of blocks are kept, and each block is filtered again on the way
// back: so it stays near the processor, where all of a long signal would go through memory.
template <int V>
inline void low_pass_columns(const LowPass& filter, const Rows& rows, std::size_t column, std::size_t to, double* work,
                             double* out) {
  const Section &one = filter.sections[0], &two = filter.sections[1];
  const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(rows.n) - 1,
                       padding = static_cast<std::ptrdiff_t>(filter.padding),
                       every = static_cast<std::ptrdiff_t>(filter.every),
                       begin = static_cast<std::ptrdiff_t>(rows.first),
                       block = static_cast<std::ptrdiff_t>(LOW_PASS_BLOCK) / V, end = last + 1 + padding,
                       blocks = (end + padding + block - 1) / block;
  const Columns<V> signal = {rows, column, last};
  const auto states = [&](std::ptrdiff_t b) { return work + 4 * static_cast<std::size_t>(b) * Wide<V>::SIZE; };
  double* const filtered = states(blocks + 1);
  SectionState<V> first, second;
  const auto forth = [&](std::ptrdiff_t b, bool stored) {
    const std::ptrdiff_t from = b * block - padding, until = b + 1 < blocks ? from + block : end;
    SectionState<V> own_first = first, own_second = second;  // in registers: samples wait for them
    Wide<V> x = {};
    for (std::ptrdiff_t i = from; i < until; ++i) {
      x = advance(two, own_second, advance(one, own_first, signal.at(i)));
      if (stored) store(filtered + static_cast<std::size_t>(i - from) * Wide<V>::SIZE, x);
    }
    first = own_first, second = own_second;
    return x;
  };
  const auto keep_states = [&](std::ptrdiff_t b) {
    keep(states(b), first), keep(states(b) + 2 * Wide<V>::SIZE, second);
  };
  const auto kept_states = [&](std::ptrdiff_t b) {
    first = kept<V>(states(b)), second = kept<V>(states(b) + 2 * Wide<V>::SIZE);
  };
  const Wide<V> x = signal.at(-padding);
  first = settled(one, x), second = settled(two, x);
  keep_states(0);
  for (std::ptrdiff_t b = 0; b + 1 < blocks; ++b) {
    forth(b, false);
    keep_states(b + 1);
  }
  for (std::ptrdiff_t b = blocks - 1; b >= 0; --b) {
    const std::ptrdiff_t from = b * block - padding, until = b + 1 < blocks ? from + block : end;
    if (until <= begin) break;
    kept_states(b);
    const Wide<V> x = forth(b, true);
    if (b + 1 == blocks) {
      first = settled(one, x), second = settled(two, x);
    } else {
      kept_states(b + 1);  // the way back begins where that of the block behind ended
    }
    SectionState<V> own_first = first, own_second = second;
    std::ptrdiff_t row = until <= begin ? -1 : ((until - 1 < last ? until - 1 : last) - begin) / every;
    for (std::ptrdiff_t i = until - 1; i >= (from > begin ? from : begin); --i) {
      const double* at = filtered + static_cast<std::size_t>(i - from) * Wide<V>::SIZE;
      const Wide<V> y = advance(two, own_second, advance(one, own_first, load_wide<V>(at)));
      if (i != begin + row * every) continue;
      double* const kept_row = out + static_cast<std::size_t>(row--) * rows.k;
      for (std::size_t v = 0, c = column; v < V && c < to; ++v, c += LANES) scatter(kept_row + c, y.part[v], to - c);
    }
    first = own_first, second = own_second;
    keep_states(b);
  }
}

// Columns [column, to) of the signal, else as in `low_pass_columns`.
inline void low_pass(const LowPass& filter, const Rows& rows, std::size_t column, std::size_t to, double* work,
                     double* out) {
  while (column < to) {
    const std::size_t left = to - column, vectors = left <= LANES ? 1 : left <= 2 * LANES ? 2 : LOW_PASS_VECTORS;
    (vectors == 1 ? low_pass_columns<1> : vectors == 2 ? low_pass_columns<2> : low_pass_columns<LOW_PASS_VECTORS>)(
        filter, rows, column, to, work, out);
    column += vectors * LANES;
  }
}

}  // namespace plantar::PLANTAR_ISA
