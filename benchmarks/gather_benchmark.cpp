// The ray phase of a gather (rays made, traced, patches found, sums taken or patch numbers kept) against
// Embree alone, which traces exactly the same rays in the same order from an array: one thread, CPU time.
// `embree_share` is Embree's time over that of the whole phase. Scenes come from generate_scene and
// examples/.

#include <benchmark/benchmark.h>
#include <dlfcn.h>
#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "luxel/mesh_scene.h"
#include "luxel/ray_scene.h"
#include "luxel/read_scene.h"
#include "transport/gather/final_gather.h"
#include "transport/gather/gather_rays.h"
#include "transport/gather/stored_rays.h"

namespace luxel {
namespace {

constexpr int lanes = GatherOperator::lanes;

/// Sixteen rays as they were given to Embree.
struct alignas(64) RecordedPacket {
  float origin[3][lanes], direction[3][lanes];
  int valid[lanes];
  RTCIntersectContextFlags flags;
};

using Intersect16 = void (*)(const int*, RTCScene, RTCIntersectContext*, RTCRayHit16*);

const Intersect16 embree_itself = reinterpret_cast<Intersect16>(dlsym(RTLD_NEXT, "rtcIntersect16"));

std::vector<RecordedPacket>* recorded = nullptr;
std::int64_t settled = 0;

void record(const int* valid, const RTCIntersectContext& context, const RTCRayHit16& rays) {
  // single rays are those that are settled in double precision: no part of what Embree has to do
  if (std::count(valid, valid + lanes, 0) >= lanes - 1) {
    ++settled;
    return;
  }
  RecordedPacket packet;
  for (int k = 0; k < lanes; ++k) {
    packet.origin[0][k] = rays.ray.org_x[k];
    packet.origin[1][k] = rays.ray.org_y[k];
    packet.origin[2][k] = rays.ray.org_z[k];
    packet.direction[0][k] = rays.ray.dir_x[k];
    packet.direction[1][k] = rays.ray.dir_y[k];
    packet.direction[2][k] = rays.ray.dir_z[k];
    packet.valid[k] = valid[k];
  }
  packet.flags = context.flags;
  recorded->push_back(packet);
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU seconds of Embree alone. The rays of each measured stretch are in the cache when it starts.
double replay(const std::vector<RecordedPacket>& packets, RTCScene scene) {
  constexpr std::size_t stretch = 1024;  // 0.5 MB of rays
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit16 rays{};
  std::fill_n(rays.ray.mask, lanes, ~0u);
  std::fill_n(rays.hit.instID[0], lanes, RTC_INVALID_GEOMETRY_ID);
  double seconds = 0;
  for (std::size_t first = 0; first < packets.size(); first += stretch) {
    const std::size_t end = std::min(packets.size(), first + stretch);
    int touched = 0;
    for (std::size_t p = first; p < end; ++p) {
      for (std::size_t at = 0; at < sizeof(RecordedPacket); at += 64) {
        touched += reinterpret_cast<const char*>(&packets[p])[at];
      }
    }
    benchmark::DoNotOptimize(touched);
    const double start = cpu_seconds();
    for (std::size_t p = first; p < end; ++p) {
      const RecordedPacket& packet = packets[p];
      std::copy_n(packet.origin[0], lanes, rays.ray.org_x);
      std::copy_n(packet.origin[1], lanes, rays.ray.org_y);
      std::copy_n(packet.origin[2], lanes, rays.ray.org_z);
      std::copy_n(packet.direction[0], lanes, rays.ray.dir_x);
      std::copy_n(packet.direction[1], lanes, rays.ray.dir_y);
      std::copy_n(packet.direction[2], lanes, rays.ray.dir_z);
      std::fill_n(rays.ray.tnear, lanes, 0.0f);
      std::fill_n(rays.ray.tfar, lanes, std::numeric_limits<float>::infinity());
      std::fill_n(rays.hit.geomID, lanes, RTC_INVALID_GEOMETRY_ID);
      context.flags = packet.flags;
      embree_itself(packet.valid, scene, &context, &rays);
    }
    benchmark::DoNotOptimize(rays);
    seconds += cpu_seconds() - start;
  }
  return seconds;
}

struct Scenery {
  PatchMesh mesh;
  std::unique_ptr<RayScene> occluders;
};

PatchMesh generated(const std::string& arguments) {
  const auto file = std::filesystem::temp_directory_path() / "luxel_gather_benchmark.obj";
  const std::string command = LUXEL_GENERATE_SCENE " " + arguments + " > " + file.string();
  if (std::system(command.c_str()) != 0) throw std::runtime_error("cannot run " + command);
  PatchMesh mesh = mesh_scene(read_scene(file), {.as_is = true});
  std::filesystem::remove(file);
  return mesh;
}

enum Kind : std::int64_t { cornell, blocks, ball, large_ball };

const Scenery& scenery(std::int64_t kind) {
  static std::map<std::int64_t, Scenery> known;
  Scenery& scenery = known[kind];
  if (scenery.occluders) return scenery;
  switch (kind) {
    case cornell:
      scenery.mesh = mesh_scene(read_scene(LUXEL_EXAMPLES "/scenes/cornell/cornell.json"), {.patches = 5700});
      break;
    case blocks:
      scenery.mesh = generated("blocks 120");
      break;
    case ball:
      scenery.mesh = generated("ball 250000");
      break;
    default:
      scenery.mesh = generated("ball 1000000");
  }
  scenery.occluders = std::make_unique<RayScene>(scenery.mesh.occluders);
  return scenery;
}

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + x.size() / 2, x.end());
  return x[x.size() / 2];
}

/// One pass over all rays is an iteration; Embree alone runs between, so that other work on the machine hits
/// both.
template <class Phase>
void measure(benchmark::State& state, const Scenery& scenery, Phase phase) {
  std::vector<RecordedPacket> packets;
  recorded = &packets;
  settled = 0;
  phase();
  recorded = nullptr;
  std::int64_t rays = 0;
  for (const RecordedPacket& packet : packets)
    rays += lanes - std::count(packet.valid, packet.valid + lanes, 0);
  auto* embree = static_cast<RTCScene>(scenery.occluders->embree_scene());
  std::vector<double> shares, alone, whole;
  for (auto _ : state) {
    const double before = replay(packets, embree);
    const double start = cpu_seconds();
    phase();
    const double seconds = cpu_seconds() - start;
    const double embree_alone = (before + replay(packets, embree)) / 2;
    state.SetIterationTime(seconds);
    shares.push_back(embree_alone / seconds);
    alone.push_back(embree_alone);
    whole.push_back(seconds);
  }
  state.counters["embree_share"] = median(shares);
  state.counters["settled"] = static_cast<double>(settled) / static_cast<double>(rays);
  state.counters["Mrays/s"] = 1e-6 * static_cast<double>(rays) / median(whole);
  state.counters["Mrays/s_embree"] = 1e-6 * static_cast<double>(rays) / median(alone);
}

/// Rays that are summed up and forgotten.
void FinalGather(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Scenery& scene = scenery(state.range(0));
  const GatherRays rays(scene.mesh, *scene.occluders, static_cast<int>(state.range(1)), 0);
  const auto stored = stored_rays(rays, 16, scene.mesh, {});
  const PatchField x = PatchField::Ones(scene.mesh.size(), 3);
  measure(state, scene, [&] {
    benchmark::DoNotOptimize(final_gather(scene.mesh, rays, *stored, 0, true, x, {}).values.data());
  });
}

/// Rays that are kept.
void StoredRays(benchmark::State& state) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Scenery& scene = scenery(state.range(0));
  const int count = static_cast<int>(state.range(1));
  const GatherRays rays(scene.mesh, *scene.occluders, count, 0);
  std::vector<std::uint32_t> met(rays.packets_together() * count * lanes);
  measure(state, scene, [&] {
    const std::size_t packets = rays.packets().size(), together = rays.packets_together();
    std::vector<PacketFrame> frames;
    for (std::size_t first = 0; first < packets; first += together) {
      rays.aim(first, std::min(together, packets - first), frames);
      rays.trace_together(first, frames, 0, count, met.data());
    }
    benchmark::DoNotOptimize(met.data());
  });
}

// As many rays as accuracies of about 0.01 take.
void settings(benchmark::internal::Benchmark* of) {
  of->ArgNames({"scene", "rays"})->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);
}

BENCHMARK(FinalGather)
    ->Apply(settings)
    ->Args({cornell, 512})
    ->Args({blocks, 192})
    ->Args({ball, 24})
    ->Args({large_ball, 16});
BENCHMARK(StoredRays)
    ->Apply(settings)
    ->Args({cornell, 512})
    ->Args({blocks, 192})
    ->Args({ball, 24})
    ->Args({large_ball, 16});

}  // namespace
}  // namespace luxel

/// Stands between the gather and Embree, to see the rays that it is given.
extern "C" void rtcIntersect16(const int* valid, RTCScene scene, RTCIntersectContext* context,
                               RTCRayHit16* rays) {
  if (luxel::recorded) luxel::record(valid, *context, *rays);
  luxel::embree_itself(valid, scene, context, rays);
}
