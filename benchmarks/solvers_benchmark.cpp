// What each way of solving costs, beside the machine's own limits measured in the same run: compare ratios,
// not seconds. CPU time is that of the whole process.

#include <benchmark/benchmark.h>
#include <cblas.h>
#include <lapack.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "linear/factor/cholesky_factor.h"
#include "linear/factor/lu_factor.h"
#include "luxel/dense_operator.h"
#include "luxel/solve.h"

namespace luxel {
namespace {

/// The inside of a unit cube in 6 k^2 squares: point-to-point factors, with the rows closed.
std::unique_ptr<DenseOperator> cube(int k) {
  std::vector<Vec3> points, normals;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      for (int u = 0; u < k; ++u) {
        for (int v = 0; v < k; ++v) {
          Vec3 point, normal = Vec3::Zero();
          point[axis] = side;
          point[(axis + 1) % 3] = (u + 0.5) / k;
          point[(axis + 2) % 3] = (v + 0.5) / k;
          normal[axis] = side ? -1 : 1;
          points.push_back(point);
          normals.push_back(normal);
        }
      }
    }
  }
  const int n = static_cast<int>(points.size());
  const double area = 1.0 / (k * k);
  ExchangeMatrix exchange(n, Precision::float32);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      const Vec3 way = points[j] - points[i];
      const double cosines = std::max(0.0, normals[i].dot(way)) * std::max(0.0, -normals[j].dot(way));
      // the disc of the same area keeps close pairs finite
      if (cosines > 0)
        exchange.set(i, j, area * area * cosines / (way.squaredNorm() * (M_PI * way.squaredNorm() + area)));
    }
  }
  Enclosures closed;
  closed.closed = true;
  closed.count = 1;
  closed.enclosure.assign(n, 0);
  closed.enclosure_closed = {1};
  closed.open_share.assign(n, 0);
  closed.back_share.assign(n, 0);
  closed.share_error.assign(n, 0);
  return std::move(close_rows(std::move(exchange), std::vector<double>(n, area), closed).transport);
}

constexpr int squares = 28;  // along an edge: 4,704 patches, near the 5,000 that a scene has by default

const DenseOperator& transport() {
  static const auto made = cube(squares);
  return *made;
}

/// Light from a sixteenth of the ceiling, in m columns of different power.
PatchField emission(int m) {
  PatchField emission = PatchField::Zero(transport().size(), m);
  for (int c = 0; c < m; ++c)
    emission.col(c).segment(squares * squares / 2, squares * squares / 16).setConstant(c + 1);
  return emission;
}

/// Float32 identity plus noise, positive definite.
std::vector<float> definite_matrix(int n) {
  std::vector<float> matrix(static_cast<std::size_t>(n) * n);
  for (std::size_t i = 0; i < matrix.size(); ++i)
    matrix[i] = 0.5f / static_cast<float>(n) * static_cast<float>(i % 7) / 7;
  for (int i = 0; i < n; ++i) matrix[static_cast<std::size_t>(i) * n + i] = 1;
  return matrix;
}

void rate(benchmark::State& state, const char* unit, double amount) {
  state.counters[unit] = benchmark::Counter(amount * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}

// --- the machine ---

void stream_read(benchmark::State& state) {
  const std::vector<float> data(std::size_t(1) << 28, 1.0f);
  constexpr int parts = 64;
  const std::size_t length = data.size() / parts;
  for (auto _ : state) {
    std::vector<float> sums(parts);
    tbb::parallel_for(0, parts, [&](int part) {
      float lanes[32] = {};
      const float* first = data.data() + part * length;
      for (std::size_t i = 0; i < length; i += 32) {
        for (int lane = 0; lane < 32; ++lane) lanes[lane] += first[i + lane];
      }
      sums[part] = std::accumulate(lanes, lanes + 32, 0.0f);
    });
    benchmark::DoNotOptimize(sums);
  }
  rate(state, "GB/s", 4.0 * static_cast<double>(data.size()));
}
BENCHMARK(stream_read)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void sgemm(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto a = definite_matrix(n);
  std::vector<float> c(a.size());
  for (auto _ : state) {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, a.data(), n, a.data(), n, 0, c.data(),
                n);
  }
  rate(state, "GF/s", 2.0 * n * n * n);
}
BENCHMARK(sgemm)->Arg(4096)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

void spotrf(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto matrix = definite_matrix(n);
  for (auto _ : state) {
    state.PauseTiming();
    auto a = matrix;
    state.ResumeTiming();
    int info = 0;
    LAPACK_spotrf("U", &n, a.data(), &n, &info);
  }
  rate(state, "GF/s", n / 3.0 * n * n);
}
BENCHMARK(spotrf)->Arg(4096)->Arg(8192)->UseRealTime()->MeasureProcessCPUTime()->Unit(
    benchmark::kMillisecond);

void sgetrf(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto matrix = definite_matrix(n);
  std::vector<int> pivots(n);
  for (auto _ : state) {
    state.PauseTiming();
    auto a = matrix;
    state.ResumeTiming();
    int info = 0;
    LAPACK_sgetrf(&n, &n, a.data(), &n, pivots.data(), &info);
  }
  rate(state, "GF/s", 2 * n / 3.0 * n * n);
}
BENCHMARK(sgetrf)->Arg(4096)->Arg(8192)->UseRealTime()->MeasureProcessCPUTime()->Unit(
    benchmark::kMillisecond);

// --- our factorisations, of the same matrices ---

void tiled_cholesky(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto matrix = definite_matrix(n);
  for (auto _ : state) {
    state.PauseTiming();
    CholeskyFactor<float> factor(
        n, [&](int i, float* row) { std::copy_n(&matrix[static_cast<std::size_t>(i) * n], i + 1, row); });
    state.ResumeTiming();
    factor.factor();
  }
  rate(state, "GF/s", n / 3.0 * n * n);
}
BENCHMARK(tiled_cholesky)
    ->Arg(4096)
    ->Arg(8192)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void panel_lu(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto matrix = definite_matrix(n);
  for (auto _ : state) {
    state.PauseTiming();
    LuFactor<float> factor(n);
    for (int j = 0; j < n; ++j) std::copy_n(&matrix[static_cast<std::size_t>(j) * n], n, factor.column(j));
    state.ResumeTiming();
    factor.factor();
  }
  rate(state, "GF/s", 2 * n / 3.0 * n * n);
}
BENCHMARK(panel_lu)->Arg(4096)->Arg(8192)->UseRealTime()->MeasureProcessCPUTime()->Unit(
    benchmark::kMillisecond);

// --- the operator and the solvers ---

void apply(benchmark::State& state) {
  const int m = static_cast<int>(state.range(0));
  const PatchField x = PatchField::Random(transport().size(), m);
  PatchField y(x.rows(), m);
  for (auto _ : state) transport().apply(x.data(), y.data(), m);
  rate(state, "GB/s", static_cast<double>(transport().bytes()));
}
BENCHMARK(apply)->Arg(1)->Arg(3)->Arg(30)->UseRealTime()->MeasureProcessCPUTime()->Unit(
    benchmark::kMillisecond);

/// Arguments: method, columns, 1000 times the reflectance.
void solve_to_1e6(benchmark::State& state) {
  SolveOptions options;
  options.method = static_cast<Method>(state.range(0));
  const PatchField light = emission(static_cast<int>(state.range(1)));
  const PatchField reflectance = PatchField::Constant(light.rows(), light.cols(), state.range(2) / 1000.0);
  SolveReport report;
  for (auto _ : state) report = solve(transport(), reflectance, light, options).report;
  state.SetLabel(std::string(name(options.method)) + (report.converged ? "" : ": " + report.message));
  state.counters["iterations"] = report.iterations;
}
BENCHMARK(solve_to_1e6)
    ->ArgsProduct({{static_cast<int>(Method::cholesky), static_cast<int>(Method::lu),
                    static_cast<int>(Method::cg), static_cast<int>(Method::gmres),
                    static_cast<int>(Method::neumann), static_cast<int>(Method::gauss_seidel),
                    static_cast<int>(Method::symmetric_gauss_seidel), static_cast<int>(Method::southwell)},
                   {1, 3, 30},
                   {800}})
    ->ArgsProduct({{static_cast<int>(Method::cholesky), static_cast<int>(Method::lu),
                    static_cast<int>(Method::cg), static_cast<int>(Method::gmres)},
                   {3},
                   {999}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace luxel
