#include "memory_plan.h"

#include <fmt/format.h>

#include "luxel/input_error.h"
#include "usage.h"
#include "values.h"

namespace luxel::app {

namespace {

// The program with its libraries loaded [bytes], measured.
constexpr double program_bytes = 64e6;

// The patches themselves, and the scene that they are cut from [bytes a patch], measured.
constexpr double mesh_patch_bytes = 300;

// Patches, clusters, ray scene, three channels of everything and the writers' buffers [bytes a patch],
// measured.
constexpr double patch_bytes = 1500;

}  // namespace

std::size_t mesh_bytes(int patches) {
  return static_cast<std::size_t>(program_bytes + mesh_patch_bytes * patches);
}

std::size_t solve_bytes(int patches, Precision precision, std::optional<Method> method) {
  const double n = patches;
  double bytes = program_bytes + patch_bytes * n;
  bytes += n * (n - 1) / 2 * (precision == Precision::float32 ? 4 : 8);
  if (method == Method::cholesky) bytes += n * (n + 1) / 2 * 8;
  if (method == Method::lu) bytes += n * n * 8;
  return static_cast<std::size_t>(bytes);
}

std::size_t memory_limit(std::size_t limit) {
  return limit > 0 ? limit : machine_bytes();
}

void check_memory(std::size_t estimate, std::size_t limit, int patches) {
  const std::size_t allowed = memory_limit(limit);
  if (estimate <= allowed) return;
  throw InputError(fmt::format(
      "--memory: {} patches need about {}, more than the {} {}; fewer --patches need less", patches,
      readable_bytes(static_cast<double>(estimate)), readable_bytes(static_cast<double>(allowed)),
      limit > 0 ? "allowed" : "that the machine has"));
}

}  // namespace luxel::app
