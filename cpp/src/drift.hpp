// Drift and slope of each sample as one banded problem: two by two blocks, eliminated forth and substituted back.
#pragma once

#include <cstddef>
#include <vector>

namespace plantar {

// Information about [drift, slope] of the samples. From one to the next the drift goes on by slope·period, plus a step of
// variance jump[i]; the slope takes one of variance `wander`. `first`: information about both before the first sample.
struct DriftChain {
  std::size_t n;
  const double *weight, *jump;
  double wander, period, first[2];
};

// A symmetric block [[p, q], [q, r]].
struct DriftBlock {
  double p, q, r;
  DriftBlock inverse() const {
    const double size = p * r - q * q;
    return {r / size, -q / size, p / size};
  }
};

// The inverses of the blocks that elimination leaves on the diagonal.
inline std::vector<DriftBlock> eliminated(const DriftChain& chain) {
  std::vector<DriftBlock> inverses(chain.n);
  const double slope = 1.0 / chain.wander;
  for (std::size_t i = 0; i < chain.n; ++i) {
    DriftBlock own = {chain.weight[i], 0.0, 0.0};
    if (i + 1 < chain.n) {
      const double step = 1.0 / chain.jump[i];
      own = {own.p + step, step * chain.period, step * chain.period * chain.period + slope};
    }
    if (i == 0) {
      own.p += chain.first[0], own.r += chain.first[1];
    } else {
      // The block before is tied by [[-step, 0], [-step·period, -slope]].
      const double step = 1.0 / chain.jump[i - 1], lead = step * chain.period;
      const DriftBlock& past = inverses[i - 1];
      const double pd = step * past.p + lead * past.q, qd = step * past.q + lead * past.r;
      own.p += step - step * pd - lead * qd;
      own.q -= slope * qd;
      own.r += slope - slope * slope * past.r;
    }
    inverses[i] = own.inverse();
  }
  return inverses;
}

// The drift that fits each of the k columns of `values` (n, k) best, into `out`.
inline void smooth_drift(const DriftChain& chain, const double* values, std::size_t k, double* out) {
  const std::vector<DriftBlock> inverses = eliminated(chain);
  std::vector<double> solved(2 * chain.n * k);  // of each sample k drifts, then k slopes
  const double slope = 1.0 / chain.wander;
  for (std::size_t i = 0; i < chain.n; ++i) {
    const DriftBlock& own = inverses[i];
    const double step = i ? 1.0 / chain.jump[i - 1] : 0.0, lead = step * chain.period, held = i ? slope : 0.0;
    double *drift = solved.data() + 2 * i * k, *rate = drift + k;
    const double *past = drift - 2 * k, *past_rate = past + k;
    for (std::size_t c = 0; c < k; ++c) {
      double right = chain.weight[i] * values[i * k + c], turn = 0.0;
      if (i) right += step * past[c] + lead * past_rate[c], turn = held * past_rate[c];
      drift[c] = own.p * right + own.q * turn;
      rate[c] = own.q * right + own.r * turn;
    }
  }
  for (std::size_t i = chain.n; i-- > 0;) {
    double *drift = solved.data() + 2 * i * k, *rate = drift + k;
    if (i + 1 < chain.n) {
      const DriftBlock& own = inverses[i];
      const double step = 1.0 / chain.jump[i], lead = step * chain.period;
      const double *next = rate + k, *next_rate = next + k;
      for (std::size_t c = 0; c < k; ++c) {
        const double right = step * next[c], turn = lead * next[c] + slope * next_rate[c];
        drift[c] += own.p * right + own.q * turn;
        rate[c] += own.q * right + own.r * turn;
      }
    }
    for (std::size_t c = 0; c < k; ++c) out[i * k + c] = drift[c];
  }
}

// Variance of the drift, (n,): the inverse's diagonal.
inline void drift_variance(const DriftChain& chain, double* out) {
  const std::vector<DriftBlock> inverses = eliminated(chain);
  const double slope = 1.0 / chain.wander;
  DriftBlock next = {};
  for (std::size_t i = chain.n; i-- > 0;) {
    const DriftBlock& own = inverses[i];
    DriftBlock here = own;
    if (i + 1 < chain.n) {
      // own + gain · covariance of the next · gainᵀ, gain = own · [[-step, 0], [-step·period, -slope]]
      const double step = 1.0 / chain.jump[i], lead = step * chain.period;
      const double pd = own.p * step + own.q * lead, qd = own.q * step + own.r * lead;
      const double ps = own.q * slope, qs = own.r * slope;
      here.p += pd * pd * next.p + 2 * pd * ps * next.q + ps * ps * next.r;
      here.q += pd * qd * next.p + (pd * qs + ps * qd) * next.q + ps * qs * next.r;
      here.r += qd * qd * next.p + 2 * qd * qs * next.q + qs * qs * next.r;
    }
    out[i] = here.p;
    next = here;
  }
}

}  // namespace plantar
