// Splitting a batch of samples over the processor's cores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace plantar {

// How many threads are worth starting for `count` samples when each should have at least `least`.
inline unsigned worthwhile_threads(std::size_t count, std::size_t least, unsigned wanted) {
  const std::size_t cores = wanted > 0 ? wanted : std::max(1u, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::clamp<std::size_t>(count / std::max<std::size_t>(least, 1), 1, cores));
}

// work(thread, begin, end) for equal contiguous parts of [0, count), the boundaries at multiples of `grain`.
template <class Work>
void parallel_parts(std::size_t count, std::size_t grain, unsigned threads, Work work) {
  const std::size_t grains = (count + grain - 1) / grain;
  const auto boundary = [&](unsigned t) { return std::min(count, grains * t / threads * grain); };
  std::vector<std::thread> others;
  for (unsigned t = 1; t < threads; ++t) {
    others.emplace_back([&, t] { work(t, boundary(t), boundary(t + 1)); });
  }
  work(0u, boundary(0), boundary(1));
  for (std::thread& thread : others) thread.join();
}

}  // namespace plantar
