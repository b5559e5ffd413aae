// Splitting a batch of samples over the processor's cores.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace plantar {

// How many threads are worth starting for `count` samples when each should have at least `least`.
inline unsigned worthwhile_threads(std::size_t count, std::size_t least, unsigned wanted) {
  const std::size_t cores = wanted > 0 ? wanted : std::max(1u, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::clamp<std::size_t>(count / least, 1, cores));
}

// work(thread, begin, end) for equal contiguous parts of [0, count), the boundaries at multiples of `grain`.
// What any part throws (memory that runs out) is thrown here, once all threads have ended.
template <class Work>
void parallel_parts(std::size_t count, std::size_t grain, unsigned threads, Work work) {
  const std::size_t grains = (count + grain - 1) / grain;
  const auto boundary = [&](unsigned t) { return std::min(count, grains * t / threads * grain); };
  std::vector<std::exception_ptr> failures(threads);
  const auto part = [&](unsigned t) noexcept {
    try {
      work(t, boundary(t), boundary(t + 1));
    } catch (...) {
      failures[t] = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(threads);
  unsigned started = 1;
  try {
    for (; started < threads; ++started) others.emplace_back(part, started);
  } catch (const std::system_error&) {
    // No more threads to be had: the parts that are left run here.
  }
  part(0u);
  for (unsigned t = started; t < threads; ++t) part(t);
  for (std::thread& thread : others) thread.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace plantar
