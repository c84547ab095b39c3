// Does the error bar hold? Solves scenes that are small enough to be known exactly with the operators at
// several accuracies and seeds, and counts how often the true error of irradiance lies in the interval that
// operator_error() gives without knowing it. The table of docs/scale.md.
//
//   error_bars SEEDS PATCHES SCENE...
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <luxel/dense_operator.h>
#include <luxel/form_factors.h>
#include <luxel/gather_operator.h>
#include <luxel/mesh_scene.h>
#include <luxel/operator_error.h>
#include <luxel/read_scene.h>
#include <luxel/solve.h>

namespace {

using namespace luxel;

// Of the reference: a thirtieth of the finest operator that is looked at.
constexpr double reference_accuracy = 2e-5;

// What the error bar may cost: an eighth of the rays of a gather.
constexpr double share_of_rays = 0.125;

struct Scene {
  PatchMesh mesh;
  PatchField rho, emitted;
  Enclosures enclosures;
};

struct Solved {
  RadiositySolution light;
  std::vector<double> row_sums;
  double rays = 0;  ///< that the error bar may take
};

double relative_error(const Scene& scene, const PatchField& found, const PatchField& exact) {
  double worst = 0;
  for (Eigen::Index c = 0; c < exact.cols(); ++c) {
    double off = 0, whole = 0;
    for (int i = 0; i < scene.mesh.size(); ++i) {
      off += scene.mesh.areas[i] * std::pow(found(i, c) - exact(i, c), 2);
      whole += scene.mesh.areas[i] * std::pow(exact(i, c), 2);
    }
    if (whole > 0) worst = std::max(worst, std::sqrt(off / whole));
  }
  return worst;
}

Solved solve_dense(const Scene& scene, double accuracy, std::uint64_t seed, Visibility visibility) {
  FormFactorOptions options;
  options.accuracy = accuracy;
  options.seed = seed;
  options.visibility = visibility;
  options.precision = Precision::float64;
  FormFactors factors = form_factors(scene.mesh, options);
  Solved solved;
  solved.row_sums = row_sums(factors.exchange_areas, scene.mesh.areas);
  const ClosedOperator closed =
      close_rows(std::move(factors.exchange_areas), scene.mesh.areas, scene.enclosures);
  SolveOptions solving;
  solving.tolerance = 1e-9;
  solved.light = solve(*closed.transport, scene.rho, scene.emitted, solving);
  solved.rays = 2e6;
  return solved;
}

Solved solve_gather(const Scene& scene, double accuracy, std::uint64_t seed) {
  GatherOptions options;
  options.accuracy = accuracy;
  options.seed = seed;
  GatheredSolution gathered =
      solve_gathered(scene.mesh, RayScene(scene.mesh.occluders), scene.rho, scene.emitted, options);
  Solved solved;
  solved.rays = share_of_rays * static_cast<double>(gathered.report.rays + gathered.report.shadow_rays);
  solved.light = std::move(gathered.light);
  solved.row_sums = std::move(gathered.row_sums);
  return solved;
}

struct Count {
  int held = 0, below = 0, above = 0, runs = 0;
  std::vector<double> truths, widths, ratios;

  void add(double truth, const OperatorError& bar) {
    ++runs;
    held += bar.low <= truth && truth <= bar.high;
    below += truth < bar.low;
    above += truth > bar.high;
    truths.push_back(truth);
    ratios.push_back(bar.estimate / truth);
    widths.push_back(bar.low > 0 ? bar.high / bar.low : INFINITY);
  }
};

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + static_cast<long>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

void print(const std::string& scene, int patches, const std::string& how, const Count& count) {
  std::printf("| %s | %d | %s | %d | %d | %d | %d | %.2g | %.2f | %.2f |\n", scene.c_str(), patches,
              how.c_str(), count.runs, count.held, count.below, count.above, median(count.truths),
              median(count.ratios), median(count.widths));
  std::fflush(stdout);
}

void add(Count& sum, const Count& part) {
  sum.runs += part.runs;
  sum.held += part.held;
}

Count study(const std::string& file, int seeds, int patches) {
  Scene scene;
  MeshingOptions meshing;
  meshing.patches = patches;
  scene.mesh = mesh_scene(read_scene(file), meshing);
  scene.rho = reflectance(scene.mesh);
  scene.emitted = emission(scene.mesh);
  const RayScene occluders(scene.mesh.occluders);
  scene.enclosures = find_enclosures(scene.mesh, occluders, 256, {}, reference_accuracy);
  const PatchField exact = solve_dense(scene, reference_accuracy, 1, Visibility::automatic).light.irradiance;
  const std::string name = file.substr(file.find_last_of('/') + 1);
  Count all;
  const auto run = [&](const std::string& how, double accuracy, auto&& solve_by) {
    Count count;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Solved solved = solve_by(accuracy, static_cast<std::uint64_t>(seed));
      OperatorErrorOptions options;
      options.accuracy = accuracy;
      options.seed = static_cast<std::uint64_t>(seed);
      options.most_rays = solved.rays;
      const OperatorError bar = operator_error(scene.mesh, occluders, scene.rho, scene.emitted, solved.light,
                                               solved.row_sums, options);
      count.add(relative_error(scene, solved.light.irradiance, exact), bar);
    }
    char text[32];
    std::snprintf(text, sizeof text, " %g", accuracy);
    print(name, scene.mesh.size(), how + text, count);
    add(all, count);
  };
  for (const double accuracy : {0.03, 0.01, 0.003}) {
    run("gather", accuracy, [&](double a, std::uint64_t seed) { return solve_gather(scene, a, seed); });
  }
  for (const double accuracy : {0.01, 0.001}) {
    run("dense, rays", accuracy,
        [&](double a, std::uint64_t seed) { return solve_dense(scene, a, seed, Visibility::rays); });
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: error_bars SEEDS PATCHES SCENE...\n", stderr);
    return 2;
  }
  try {
    std::puts(
        "| scene | patches | operator | runs | held | below | above | true error | estimate / true | high / "
        "low |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|");
    Count all;
    for (int k = 3; k < argc; ++k) add(all, study(argv[k], std::atoi(argv[1]), std::atoi(argv[2])));
    std::printf("\nheld %d of %d\n", all.held, all.runs);
    return all.held >= 0.95 * all.runs ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error_bars: %s\n", error.what());
    return 1;
  }
}
