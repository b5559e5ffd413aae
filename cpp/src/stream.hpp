// Eq. 1 over any number of samples in constant memory: one R factor for each row of the equation.
//
// A row (a component of the base wrench, or a joint) has only the columns it depends on: a force no inertia, a joint
// nothing outside its own branch. Its last columns are given by the caller: terms of the joint, the measured side.
// Rows of one group have the same columns and share a factor.
//
// A large batch goes in by way of BᵀB, where that is safe (see Factor::take_gram), and by Householder's reflections
// otherwise.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "factor.hpp"
#include "parallel.hpp"

namespace plantar {

// Which parameters a row depends on, and where each link's columns start.
struct RowLayout {
  std::vector<std::int32_t> parameters;    // 10 * link + parameter, increasing
  std::vector<std::int32_t> first_column;  // of each link, -1 where the row does not depend on it
  std::size_t extras = 0;
};

inline bool carried_by(const Tree& tree, std::int32_t link, std::int32_t joint) {
  while (link > joint) link = tree.links[link].parent;
  return link == joint;
}

inline RowLayout row_layout(const Tree& tree, const std::vector<std::uint32_t>& kept, std::int32_t row) {
  RowLayout layout;
  const bool base = tree.floating && row < BASE_ROWS, force = base && row < 3;
  const std::int32_t joint = row - tree.row_of(0);
  for (std::int32_t link = 0; link < tree.n_links; ++link) {
    layout.first_column.push_back(-1);
    if (!base && !carried_by(tree, link, joint)) continue;
    layout.first_column.back() = static_cast<std::int32_t>(layout.parameters.size());
    for (int p = 0; p < (force ? FORCE_PARAMETERS : PARAMETERS); ++p)
      if (kept[link] >> p & 1u) layout.parameters.push_back(PARAMETERS * link + p);
  }
  return layout;
}

constexpr std::size_t PRODUCT_SAMPLES = 128;  // whose rows of eq. 1 stay in the second-level cache
constexpr std::size_t ENOUGH_ROWS = 4;        // a column: fewer are not worth the triangle's own cost

class Stream {
 public:
  // extras: how many columns the caller gives for each row; a row with none is left out. groups: for each row the
  // number of its group, from 0.
  Stream(const Tree& tree, std::vector<std::uint32_t> kept, const std::vector<std::size_t>& extras,
         const std::vector<std::size_t>& groups)
      : tree_(tree), kept_(std::move(kept)) {
    for (std::int32_t row = 0; row < tree_.n_rows(); ++row) {
      layouts_.push_back(row_layout(tree_, kept_, row));
      layouts_.back().extras = extras[row];
      if (extras[row] == 0) continue;
      if (groups[row] > groups_.size()) throw std::invalid_argument("groups are numbered from 0, without gaps");
      if (groups[row] == groups_.size()) groups_.emplace_back(layouts_.back());
      Group& group = groups_[groups[row]];
      const RowLayout& first = group.rows.empty() ? layouts_.back() : layouts_[group.rows.front()];
      if (first.parameters != layouts_.back().parameters || first.extras != extras[row])
        throw std::invalid_argument("rows of one group depend on the same columns");
      group.rows.push_back(row);
    }
  }

  const RowLayout& layout(std::size_t row) const { return layouts_[row]; }
  std::size_t rows() const { return layouts_.size(); }
  std::size_t groups() const { return groups_.size(); }
  std::size_t first_row(std::size_t group) const { return groups_[group].rows.front(); }

  void add(const Kernels& kernels, const Motion& motion, const std::vector<std::vector<Column>>& extras,
           std::size_t samples, unsigned threads) {
    threads = worthwhile_threads(samples, 2 * QR_MAX_ROWS, threads);
    const Batch batch = {motion, extras, samples};
    const std::vector<bool> done = add_products(kernels, batch, threads);
    if (std::find(done.begin(), done.end(), false) != done.end()) add_reflections(kernels, batch, threads, done);
  }

  // R of one group's rows over all samples so far, row-major.
  void factor(std::size_t group, double* out) const { groups_[group].factor.copy_upper(out); }

 private:
  struct Group {
    std::vector<std::size_t> rows;
    Factor factor;
    bool squared = true;  // as long as BᵀB was safe
    explicit Group(const RowLayout& layout) : factor(layout.parameters.size() + layout.extras) {}
  };

  struct Batch {
    const Motion& motion;
    const std::vector<std::vector<Column>>& extras;
    std::size_t samples;
  };

  // Where a thread writes some groups' rows of the equation for a block of samples.
  struct Blocks {
    std::vector<Aligned> data;  // of each row
    std::vector<RowSink> sinks;
    Aligned link_work;

    Blocks(const Stream& stream, const Kernels& kernels, const std::vector<bool>& wanted)
        : data(stream.rows()), link_work(aligned_bytes(kernels.link_work * stream.tree_.n_links)) {
      for (const RowLayout& layout : stream.layouts_)
        sinks.push_back({nullptr, Factor::block_stride, layout.first_column.data()});
      for (std::size_t g = 0; g < wanted.size(); ++g) {
        if (!wanted[g]) continue;
        for (const std::size_t row : stream.groups_[g].rows) {
          data[row] = stream.groups_[g].factor.new_block();
          sinks[row].data = data[row].get();
        }
      }
    }

    // Rows beyond the last sample, up to a multiple of QR_ROWS, are zero.
    void fill(const Stream& stream, const Kernels& kernels, const Batch& batch, std::size_t begin, std::size_t end) {
      const std::size_t count = end - begin, padded = round_up(count, QR_ROWS);
      kernels.regressor(stream.tree_, batch.motion, stream.kept_.data(), sinks.data(), begin, end, 0, link_work.get());
      for (std::size_t row = 0; row < data.size(); ++row) {
        if (data[row] == nullptr) continue;
        double* column = data[row].get() + stream.layouts_[row].parameters.size() * Factor::block_stride;
        for (const Column& extra : batch.extras[row]) {
          for (std::size_t i = 0; i < count; ++i)
            column[i] = extra.data[static_cast<std::ptrdiff_t>(begin + i) * extra.stride];
          column += Factor::block_stride;
        }
        for (double* c = data[row].get(); c < column; c += Factor::block_stride) std::fill(c + count, c + padded, 0.0);
      }
    }
  };

  // The groups whose BᵀB served; the others are as they were.
  std::vector<bool> add_products(const Kernels& kernels, const Batch& batch, unsigned threads) {
    std::vector<bool> tried;
    for (const Group& group : groups_)
      tried.push_back(group.squared && batch.samples * group.rows.size() >= ENOUGH_ROWS * group.factor.columns());
    if (std::find(tried.begin(), tried.end(), true) == tried.end()) return tried;
    std::vector<std::vector<Aligned>> grams(threads);
    parallel_parts(batch.samples, PRODUCT_SAMPLES, threads, [&](unsigned thread, std::size_t begin, std::size_t end) {
      Blocks blocks(*this, kernels, tried);
      for (std::size_t g = 0; g < groups_.size(); ++g)
        grams[thread].push_back(tried[g] ? groups_[g].factor.new_gram() : Aligned());
      for (; begin < end; begin += PRODUCT_SAMPLES) {
        const std::size_t stop = std::min(end, begin + PRODUCT_SAMPLES), padded = round_up(stop - begin, QR_ROWS);
        blocks.fill(*this, kernels, batch, begin, stop);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
          if (!tried[g]) continue;
          const Factor& factor = groups_[g].factor;
          for (const std::size_t row : groups_[g].rows)
            kernels.gram_update(grams[thread][g].get(), factor.gram_stride(), blocks.data[row].get(),
                                Factor::block_stride, padded, factor.columns());
        }
      }
    });
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!tried[g]) continue;
      Factor& factor = groups_[g].factor;
      for (unsigned thread = 1; thread < threads; ++thread)
        for (std::size_t k = 0; k < factor.gram_size(); ++k) grams[0][g][k] += grams[thread][g][k];
      tried[g] = groups_[g].squared = factor.take_gram(kernels, grams[0][g].get());
    }
    return tried;
  }

  void add_reflections(const Kernels& kernels, const Batch& batch, unsigned threads, const std::vector<bool>& done) {
    std::vector<bool> wanted(done);
    wanted.flip();
    // The first thread works on the groups' own factors, the others on factors that join them afterwards.
    std::vector<std::vector<Factor>> others(threads - 1);
    for (std::vector<Factor>& other : others)
      for (std::size_t g = 0; g < groups_.size(); ++g) other.emplace_back(wanted[g] ? groups_[g].factor.columns() : 0);
    parallel_parts(batch.samples, QR_MAX_ROWS, threads, [&](unsigned thread, std::size_t begin, std::size_t end) {
      Blocks blocks(*this, kernels, wanted);
      Aligned work = aligned_bytes(kernels.qr_work);
      for (; begin < end; begin += QR_MAX_ROWS) {
        const std::size_t stop = std::min(end, begin + QR_MAX_ROWS);
        blocks.fill(*this, kernels, batch, begin, stop);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
          if (!wanted[g]) continue;
          Factor& factor = thread == 0 ? groups_[g].factor : others[thread - 1][g];
          for (const std::size_t row : groups_[g].rows)
            factor.take(kernels, blocks.data[row].get(), stop - begin, nullptr, work.get());
        }
      }
    });
    for (const std::vector<Factor>& other : others)
      for (std::size_t g = 0; g < groups_.size(); ++g)
        if (wanted[g]) groups_[g].factor.take(kernels, other[g]);
  }

  Tree tree_;
  std::vector<std::uint32_t> kept_;
  std::vector<RowLayout> layouts_;
  std::vector<Group> groups_;
};

}  // namespace plantar
