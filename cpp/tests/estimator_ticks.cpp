// How long a tick takes and what it asks of the system: estimator_ticks MODEL TICKS [strict].
//
// Prints median, 99.9 % quantile and largest time [µs] and the allocations after construction, as JSON; also the 99.9 %
// quantile of plain arithmetic that takes as long as the median tick: what this machine's interrupts add to anything.
// `strict` lets the kernel kill the process at its first system call: exit code 0 says that there was none.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "plantar/foot_estimator.hpp"
#ifdef __linux__
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

static long allocations = 0;

#ifdef __GLIBC__
// Everything that asks for memory comes through here, operator new too.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#else
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace {

// A robot that shifts from foot to foot and stands between, its joints in motion, with noise in every sensor.
struct Robot {
  explicit Robot(const plantar::EstimatorModel& model)
      : weight(model.weight), position(model.joints.size()), velocity(model.joints.size()), wrench(model.feet.size()) {}

  double noise() {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state >> 11) / 4503599627370496.0 - 1.0;
  }

  void move(double t) {
    for (std::size_t j = 0; j < position.size(); ++j) {
      position[j] = 0.2 * std::sin(0.7 * t + static_cast<double>(j)) + 1e-5 * noise();
      velocity[j] = 0.14 * std::cos(0.7 * t + static_cast<double>(j)) + 1e-3 * noise();
    }
    const double p = 0.02 * std::sin(2.0 * t), r = 0.02 * std::sin(3.0 * t);
    attitude[0] = 1.0, attitude[1] = r + 1e-5 * noise(), attitude[2] = p + 1e-5 * noise(), attitude[3] = 1e-5 * noise();
    for (double& w : gyroscope) w = 0.05 * std::cos(2.0 * t) + 1e-3 * noise();
    const bool walks = std::fmod(t, 60.0) > 20.0;
    for (std::size_t f = 0; f < wrench.size(); ++f) {
      const double share =
          walks ? std::clamp(0.5 + 1.5 * std::sin(3.1 * t + 3.14 * static_cast<double>(f)), 0.0, 1.0) : 0.5;
      wrench[f] = {
          5.0 * noise(), 5.0 * noise(), share * weight + noise(), 10.0 * r + 0.1 * noise(), 10.0 * p + 0.1 * noise(),
          0.1 * noise()};
    }
  }

  plantar::Reading reading(double t) const { return {t, position, velocity, attitude, gyroscope, {}, wrench}; }

  double weight;
  std::uint64_t state = 1;
  std::vector<double> position, velocity;
  double attitude[4] = {}, gyroscope[3] = {};
  std::vector<std::array<double, 6>> wrench;
};

float microseconds_since(std::chrono::steady_clock::time_point begun) {
  return std::chrono::duration<float, std::micro>(std::chrono::steady_clock::now() - begun).count();
}

// Microseconds that a row of multiplications takes.
float arithmetic(long multiplications) {
  volatile double product = 1.0;
  const auto begun = std::chrono::steady_clock::now();
  for (long i = 0; i < multiplications; ++i) product = product * 1.0000001;
  return microseconds_since(begun);
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "estimator_ticks MODEL TICKS [strict]\n");
    return 2;
  }
  const plantar::EstimatorModel model = plantar::load_model(words[1]);
  const long ticks = std::atol(words[2]);
  const bool strict = count > 3 && std::strcmp(words[3], "strict") == 0;
  plantar::FootEstimator estimator(model);
  Robot robot(model);
  std::vector<float> times(static_cast<std::size_t>(ticks));
  std::uint64_t learnt = 0;
  const long before = allocations;
  if (strict) {
#ifdef __linux__
    if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0) return 3;
#else
    return 3;
#endif
  }
  for (long i = 0; i < ticks; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    robot.move(t);
    // Under strict rules a clock may be a system call.
    const auto begun = strict ? std::chrono::steady_clock::time_point() : std::chrono::steady_clock::now();
    const auto feet = estimator.step(robot.reading(t));
    if (!strict) times[static_cast<std::size_t>(i)] = microseconds_since(begun);
    learnt += feet[0].pitch.stiffness.value != 0.0;
  }
#ifdef __linux__
  if (strict) syscall(SYS_exit, learnt > 0 ? 0 : 4);
#endif
  const long asked = allocations - before;
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) { return times[static_cast<std::size_t>(share * static_cast<double>(ticks - 1))]; };
  const float median = at(0.5), p999 = at(0.999), max = at(1.0);
  const long many = 1'000'000;
  const long multiplications = static_cast<long>(static_cast<float>(many) * median / arithmetic(many));
  for (float& time : times) time = arithmetic(multiplications);
  std::sort(times.begin(), times.end());
  std::printf(
      "{\"median\": %.2f, \"p999\": %.2f, \"max\": %.2f, \"machine_p999\": %.2f, \"allocations\": %ld}\n", median, p999, max,
      at(0.999), asked);
  return learnt > 0 ? 0 : 4;
}
