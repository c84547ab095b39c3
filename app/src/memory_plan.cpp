#include "memory_plan.h"

#include <fmt/format.h>

#include "luxel/input_error.h"
#include "usage.h"
#include "values.h"

namespace luxel::app {

namespace {

// 4000 patches are 64 MB in float64, less than the libraries and the patches themselves take at that size.
constexpr int small_system = 4000;

// Row sums of float32 entries are off by 3e-8 RMS and up to 1e-7 (measured at 10 000 patches).
constexpr double float32_accuracy = 2e-7;

// The program with its libraries loaded [bytes], measured.
constexpr double program_bytes = 64e6;

// Patches, clusters, ray scene, three channels of everything and the writers' buffers [bytes a patch],
// measured.
constexpr double patch_bytes = 1500;

}  // namespace

Precision storage_precision(int patches, double accuracy) {
  return patches <= small_system || accuracy < float32_accuracy ? Precision::float64 : Precision::float32;
}

std::size_t mesh_bytes(int patches) {
  return static_cast<std::size_t>(program_bytes + patch_bytes * patches);
}

std::size_t solve_bytes(int patches, Precision precision, std::optional<Method> method) {
  const double n = patches;
  double bytes = static_cast<double>(mesh_bytes(patches));
  bytes += n * (n - 1) / 2 * (precision == Precision::float32 ? 4 : 8);
  if (method == Method::cholesky) bytes += n * (n + 1) / 2 * 8;
  if (method == Method::lu) bytes += n * n * 8;
  return static_cast<std::size_t>(bytes);
}

void check_memory(std::size_t estimate, std::size_t limit, int patches) {
  const std::size_t allowed = limit > 0 ? limit : machine_bytes();
  if (estimate <= allowed) return;
  throw InputError(fmt::format(
      "--memory: {} patches need about {}, more than the {} {}; fewer --patches need less", patches,
      readable_bytes(static_cast<double>(estimate)), readable_bytes(static_cast<double>(allowed)),
      limit > 0 ? "allowed" : "that the machine has"));
}

}  // namespace luxel::app
