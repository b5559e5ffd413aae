// Eq. 1 over any number of samples in constant memory: one R factor for each row of the equation.
//
// A row (a component of the base wrench, or a joint) has only the columns it depends on: a force no inertia, a joint
// nothing outside its own branch. Its last columns are given by the caller: terms of the joint, the measured side.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
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

class Stream {
 public:
  // extras: how many columns the caller gives for each row; a row with none is left out.
  Stream(const Tree& tree, std::vector<std::uint32_t> kept, const std::vector<std::size_t>& extras)
      : tree_(tree), kept_(std::move(kept)) {
    for (std::int32_t row = 0; row < tree_.n_rows(); ++row) {
      layouts_.push_back(row_layout(tree_, kept_, row));
      layouts_.back().extras = extras[row];
    }
  }

  const RowLayout& layout(std::size_t row) const { return layouts_[row]; }
  std::size_t rows() const { return layouts_.size(); }

  void add(const Kernels& kernels, const Motion& motion, const std::vector<std::vector<Column>>& extras,
           std::size_t samples, unsigned threads) {
    threads = worthwhile_threads(samples, 2 * QR_MAX_ROWS, threads);
    while (threads_.size() < threads) threads_.emplace_back(layouts_, tree_, kernels);
    parallel_parts(samples, QR_MAX_ROWS, threads, [&](unsigned thread, std::size_t begin, std::size_t end) {
      for (; begin < end; begin += QR_MAX_ROWS)
        threads_[thread].take(*this, kernels, motion, extras, begin, std::min(end, begin + QR_MAX_ROWS));
    });
  }

  // R of one row over all samples so far, row-major.
  void factor(const Kernels& kernels, std::size_t row, double* out) const {
    if (threads_.empty()) {
      Factor(layouts_[row].parameters.size() + layouts_[row].extras).copy_upper(out);
      return;
    }
    Factor all = threads_.front().factors[row]->copy();
    for (std::size_t k = 1; k < threads_.size(); ++k) all.take(kernels, *threads_[k].factors[row]);
    all.copy_upper(out);
  }

 private:
  // What one thread fills: for each row its factor and the block that is about to go in.
  struct ThreadFactors {
    std::vector<std::optional<Factor>> factors;
    std::vector<Aligned> blocks;
    std::vector<RowSink> sinks;
    Aligned link_work, qr_work;

    ThreadFactors(const std::vector<RowLayout>& layouts, const Tree& tree, const Kernels& kernels)
        : link_work(aligned_bytes(kernels.link_work * tree.n_links)), qr_work(aligned_bytes(kernels.qr_work)) {
      for (const RowLayout& layout : layouts) {
        factors.emplace_back();
        blocks.emplace_back();
        sinks.push_back({nullptr, Factor::block_stride, layout.first_column.data()});
        if (layout.extras == 0) continue;
        factors.back().emplace(layout.parameters.size() + layout.extras);
        blocks.back() = factors.back()->new_block();
        sinks.back().data = blocks.back().get();
      }
    }

    void take(const Stream& stream, const Kernels& kernels, const Motion& motion,
              const std::vector<std::vector<Column>>& extras, std::size_t begin, std::size_t end) {
      const std::size_t count = end - begin, padded = round_up(count, QR_ROWS);
      kernels.regressor(stream.tree_, motion, stream.kept_.data(), sinks.data(), begin, end, 0, link_work.get());
      for (std::size_t row = 0; row < factors.size(); ++row) {
        if (!factors[row]) continue;
        double* column = blocks[row].get() + stream.layouts_[row].parameters.size() * Factor::block_stride;
        for (const Column& extra : extras[row]) {
          for (std::size_t i = 0; i < count; ++i)
            column[i] = extra.data[static_cast<std::ptrdiff_t>(begin + i) * extra.stride];
          column += Factor::block_stride;
        }
        for (double* c = blocks[row].get(); c < column; c += Factor::block_stride) std::fill(c + count, c + padded, 0.0);
        factors[row]->take(kernels, blocks[row].get(), count, nullptr, qr_work.get());
      }
    }
  };

  Tree tree_;
  std::vector<std::uint32_t> kept_;
  std::vector<RowLayout> layouts_;
  std::vector<ThreadFactors> threads_;
};

}  // namespace plantar
