// The kernels as a table of functions, one table per instruction set, the best chosen when the core loads.
#pragma once

#include <cstdint>

#include "chain.hpp"
#include "low_pass.hpp"
#include "qr.hpp"
#include "sole_load.hpp"
#include "tree.hpp"

namespace plantar {

// All work on samples [begin, end) and may run at the same time on different samples. `work` is aligned to 64
// bytes and holds `link_work` bytes a link, or `qr_work` bytes.
struct Kernels {
  const char* name;
  std::size_t link_work;
  std::size_t qr_work;
  void (*chain)(const Chain&, const Attitude&, std::size_t begin, std::size_t end, double* const* out);
  void (*chain_bundle)(const Bundle&, const Attitude&, double* out);
  void (*sole_load)(const SoleLoad&, std::size_t begin, std::size_t end, double* const* out);
  void (*regressor)(const Tree&, const Motion&, const std::uint32_t* kept, const RowSink* sinks, std::size_t begin,
                    std::size_t end, std::size_t offset, double* work);
  void (*inverse_dynamics)(const Tree&, const Motion&, const double* parameters, const Contact* contacts,
                           std::size_t n_contacts, std::size_t begin, std::size_t end, double* const* rows,
                           double* work);
  void (*base_wrenches)(const Tree&, const Motion&, const double* parameters, std::size_t sets, std::size_t begin,
                        std::size_t end, std::size_t samples, double* out, double* work);
  void (*root_motion)(const Tree&, const Carried& imu, const Motion& joints, const Column* measured, std::size_t begin,
                      std::size_t end, double* out);
  void (*base_transfer)(const Tree&, const Carried& contact, const Column* positions, std::size_t begin,
                        std::size_t end, double* out);
  void (*qr_update)(const Triangle&, const Block&, void* work);
  void (*gram_update)(double* gram, std::size_t gram_stride, const double* block, std::size_t stride, std::size_t rows,
                      std::size_t columns);
  bool (*cholesky)(const double* gram, std::size_t gram_stride, std::size_t n, double safe, double* r,
                   std::size_t stride, double* work);
  // Columns [column, to); `work` holds `low_pass_work` doubles.
  std::size_t lanes;
  void (*low_pass)(const LowPass&, const Rows&, std::size_t column, std::size_t to, double* work, double* out);
};

// The tables that this build holds and this processor can run, best first; null ends the list.
const Kernels* const* runnable_kernels();

}  // namespace plantar
