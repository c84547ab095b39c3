// Does the error bar hold? Solves scenes that are small enough to be known exactly with the operators at
// several accuracies and seeds, as the program does, and counts how often the true error of irradiance lies
// in the interval that the run gives without knowing it. The table of docs/scale.md.
//
//   error_bars SEEDS PATCHES REFERENCE SCENE...
//
// REFERENCE: the accuracy of the dense operator that is held for the truth; the table has 2e-5, and 1e-4 for
// the torus, whose facets hide one another.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <luxel/mesh_scene.h>
#include <luxel/plan.h>
#include <luxel/read_scene.h>

namespace {

using namespace luxel;

// Of the solver, relative residual: far below every operator's error.
constexpr double tolerance = 1e-7;

struct Scene {
  PatchMesh mesh;
  Enclosures enclosures;
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

PlanOptions options_of(double accuracy, std::uint64_t seed) {
  PlanOptions options;
  options.form_factors.accuracy = accuracy;
  options.form_factors.seed = seed;
  options.solve.tolerance = tolerance;
  options.error_bar = true;
  return options;
}

PlannedSolution run_dense(const Scene& scene, const PlanOptions& options) {
  return run_plan(make_plan(scene.mesh, scene.enclosures, options), scene.mesh, scene.enclosures, options);
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

Count study(const std::string& file, int seeds, int patches, double reference_accuracy) {
  Scene scene;
  MeshingOptions meshing;
  meshing.patches = patches;
  scene.mesh = mesh_scene(read_scene(file), meshing);
  scene.enclosures = find_enclosures(scene.mesh, RayScene(scene.mesh.occluders), 256, {}, reference_accuracy);
  PlanOptions accurate = options_of(reference_accuracy, 0);
  accurate.error_bar = false;
  const PatchField exact = run_dense(scene, accurate).solution.irradiance;
  const std::string name = file.substr(file.find_last_of('/') + 1);
  Count all;
  const auto run = [&](const std::string& how, double accuracy, auto&& light_by) {
    Count count;
    for (int seed = 1; seed <= seeds; ++seed) {
      const PlannedSolution light = light_by(options_of(accuracy, static_cast<std::uint64_t>(seed)));
      count.add(relative_error(scene, light.solution.irradiance, exact), light.operator_error.value());
    }
    char text[32];
    std::snprintf(text, sizeof text, " %g", accuracy);
    print(name, scene.mesh.size(), how + text, count);
    add(all, count);
  };
  for (const double accuracy : {0.03, 0.01, 0.003}) {
    run("gather", accuracy,
        [&](const PlanOptions& options) { return run_gathered(scene.mesh, options).light; });
  }
  for (const double accuracy : {0.03, 0.01, 0.003}) {
    run("hierarchical", accuracy,
        [&](const PlanOptions& options) { return run_hierarchical(scene.mesh, options).light; });
  }
  for (const double accuracy : {0.01, 0.001}) {
    run("dense, rays", accuracy, [&](PlanOptions options) {
      options.form_factors.visibility = Visibility::rays;
      return run_dense(scene, options);
    });
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: error_bars SEEDS PATCHES REFERENCE SCENE...\n", stderr);
    return 2;
  }
  try {
    std::puts(
        "| scene | patches | operator | runs | held | below | above | true error | estimate / true | high / "
        "low |");
    std::puts("|---|---|---|---|---|---|---|---|---|---|");
    Count all;
    for (int k = 4; k < argc; ++k) {
      add(all, study(argv[k], std::atoi(argv[1]), std::atoi(argv[2]), std::atof(argv[3])));
    }
    std::printf("\nheld %d of %d\n", all.held, all.runs);
    return all.held >= 0.95 * all.runs ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error_bars: %s\n", error.what());
    return 1;
  }
}
