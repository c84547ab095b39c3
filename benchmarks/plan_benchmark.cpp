// What each saving of a plan is worth: CPU seconds from the meshed scene to its light, with every saving,
// with none, and with each one switched off alone. Usage: luxel_plan_benchmark PATCHES REPEATS SCENE... The
// least of the repeats counts, which are taken in turns, so that other work on the machine hits all alike.

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "luxel/mesh_scene.h"
#include "luxel/plan.h"
#include "luxel/read_scene.h"

namespace luxel {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) { return time.tv_sec + 1e-6 * time.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Variant {
  const char* name;
  PlanOptions options;
  double seconds = INFINITY;
  PlannedSolution light{};
};

std::vector<Variant> variants() {
  std::vector<Variant> all;
  const auto with = [&](const char* name, bool Savings::*off) {
    all.push_back({name, {}});
    if (off) all.back().options.savings.*off = false;
  };
  with("all on", nullptr);
  all.push_back({"all off", {}});
  all.back().options.savings = Savings::none();
  with("dark", &Savings::dark_enclosures);
  with("separate", &Savings::separate_enclosures);
  with("occluders", &Savings::idle_occluders);
  with("channels", &Savings::channels);
  with("method", &Savings::method);
  with("precision", &Savings::precision);
  return all;
}

void run(Variant& variant, const PatchMesh& mesh) {
  const double start = cpu_seconds();
  const Enclosures enclosures = planned_enclosures(mesh, variant.options);
  variant.light = run_plan(make_plan(mesh, enclosures, variant.options), mesh, enclosures, variant.options);
  variant.seconds = std::min(variant.seconds, cpu_seconds() - start);
}

/// Area-weighted relative RMS difference of irradiance, worst channel.
double difference(const PatchMesh& mesh, const PatchField& one, const PatchField& other) {
  const Eigen::Map<const Eigen::VectorXd> areas(mesh.areas.data(), mesh.size());
  double worst = 0;
  for (Eigen::Index c = 0; c < one.cols(); ++c) {
    const double scale = areas.dot(other.col(c).cwiseAbs2());
    if (scale > 0) worst = std::max(worst, std::sqrt(areas.dot((one - other).col(c).cwiseAbs2()) / scale));
  }
  return worst;
}

void measure(const char* file, int patches, int repeats) {
  const double start = cpu_seconds();
  const PatchMesh mesh = mesh_scene(read_scene(file), {.patches = patches});
  const double meshing = cpu_seconds() - start;
  std::vector<Variant> all = variants();
  for (int turn = 0; turn < repeats; ++turn) {
    for (Variant& variant : all) run(variant, mesh);
  }
  const Enclosures enclosures = planned_enclosures(mesh);
  const Plan plan = make_plan(mesh, enclosures);
  const double before = cpu_seconds();
  const Cost cost = estimated_cost(plan, mesh, enclosures);
  std::printf("%s: %d patches, %zu systems; difference of irradiance %.1e\n", file, mesh.size(),
              plan.systems.size(),
              difference(mesh, all[0].light.solution.irradiance, all[1].light.solution.irradiance));
  for (const Variant& variant : all) std::printf("  %-10s %8.3f s\n", variant.name, variant.seconds);
  std::printf("  estimated  %8.3f s of %.3f s, meshing included (made in %.3f s); %.0f MB\n",
              cost.cpu_seconds, meshing + all[0].seconds, cpu_seconds() - before, cost.bytes / 1e6);
  for (const LeftOut& item : plan.left_out) {
    std::printf("  left out: %s: %s (%s)\n", item.what.c_str(), item.why.c_str(), item.saved.c_str());
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace luxel

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: luxel_plan_benchmark PATCHES REPEATS SCENE...\n");
    return 2;
  }
  try {
    for (int k = 3; k < argc; ++k) luxel::measure(argv[k], std::atoi(argv[1]), std::atoi(argv[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "luxel_plan_benchmark: %s\n", error.what());
    return 1;
  }
}
