#include <benchmark/benchmark.h>
#include <tbb/parallel_for.h>

#include <array>
#include <numeric>

#include "luxel/dense_operator.h"

namespace luxel {
namespace {

/// Exchange areas of a closed sphere of equal patches, each disturbed by up to `noise`.
ExchangeMatrix sphere(int size, double noise) {
  ExchangeMatrix matrix(size, Precision::float32);
  tbb::parallel_for(0, size, [&](int i) {
    std::uint32_t state = static_cast<std::uint32_t>(i) * 7919u + 1u;
    for (int j = 0; j < i; ++j) {
      state = state * 1664525u + 1013904223u;  // Knuth and Lewis
      matrix.row<float>(i)[j] = static_cast<float>((1 + noise * (state * 0x1p-31 - 1)) / size);
    }
  });
  return matrix;
}

/// The machine's limit: reading the memory of a matrix of this many patches, with all cores.
void StreamRead(benchmark::State& state) {
  const ExchangeMatrix matrix = sphere(static_cast<int>(state.range(0)), 0);
  constexpr std::size_t parts = 64, lanes = 32;
  const auto* words = reinterpret_cast<const std::uint64_t*>(matrix.row<float>(0));
  const std::size_t words_a_part = matrix.bytes() / sizeof(std::uint64_t) / parts;
  for (auto _ : state) {
    std::array<std::uint64_t, parts> sums{};
    tbb::parallel_for(std::size_t{0}, parts, [&](std::size_t p) {
      std::array<std::uint64_t, lanes> sum{};
      const std::uint64_t* from = words + p * words_a_part;
      for (std::size_t k = 0; k + lanes <= words_a_part; k += lanes) {
        for (std::size_t l = 0; l < lanes; ++l) sum[l] += from[k + l];
      }
      sums[p] = std::accumulate(sum.begin(), sum.end(), std::uint64_t{0});
    });
    benchmark::DoNotOptimize(sums);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * matrix.bytes()));
}

/// apply() on so many right-hand sides; its bytes are those of one read of the matrix.
void Apply(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0)), columns = static_cast<int>(state.range(1));
  const DenseOperator transport(sphere(size, 0), std::vector<double>(size, 1.0));
  const PatchField x = PatchField::Random(size, columns);
  PatchField y(size, columns);
  for (auto _ : state) {
    transport.apply(x.data(), y.data(), columns);
    benchmark::DoNotOptimize(y.data());
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * transport.entries()->bytes()));
}

/// Closing rows that are off by about one part in a thousand entry by entry.
void CloseRows(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  Enclosures enclosures;
  enclosures.closed = true;
  enclosures.count = 1;
  enclosures.enclosure.assign(size, 0);
  enclosures.enclosure_closed = {1};
  for (auto* share : {&enclosures.open_share, &enclosures.back_share, &enclosures.share_error}) {
    share->assign(size, 0.0);
  }
  for (auto _ : state) {
    state.PauseTiming();
    ExchangeMatrix matrix = sphere(size, 1e-3);
    state.ResumeTiming();
    benchmark::DoNotOptimize(close_rows(std::move(matrix), std::vector<double>(size, 1.0), enclosures));
  }
}

BENCHMARK(StreamRead)->Arg(16384)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(Apply)
    ->ArgsProduct({{16384}, {1, 3}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(CloseRows)->Arg(10000)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace luxel
