#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include <limits>
#include <vector>

#include "enclosures/hemisphere_rays.h"
#include "luxel/enclosures.h"
#include "luxel/ray_scene.h"
#include "solver/hand_made_mesh.h"

namespace luxel {
namespace {

/// A room with n^3 boxes in it.
PatchMesh clutter(int n) {
  testing::Boxes boxes = testing::Boxes().add({0, 0, 0}, {1, 1, 1}, true);
  const double step = 1.0 / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Vec3 low = step * Vec3(i + 0.3, j + 0.2 + 0.1 * (i % 2), k + 0.25);
        boxes.add(low, low + step * Vec3(0.4, 0.35, 0.5), false);
      }
    }
  }
  return boxes.mesh();
}

/// Rays of the enclosure stage, patch after patch.
HemisphereRays all_rays(const PatchMesh& mesh, int rays_a_patch) {
  HemisphereRays all;
  for (int i = 0; i < mesh.size(); ++i) {
    const HemisphereRays rays = hemisphere_rays(mesh, i, rays_a_patch, i, 1e-6);
    all.origins.insert(all.origins.end(), rays.origins.begin(), rays.origins.end());
    all.normals.insert(all.normals.end(), rays.normals.begin(), rays.normals.end());
    all.directions.insert(all.directions.end(), rays.directions.begin(), rays.directions.end());
  }
  return all;
}

/// The machine's limit: Embree alone, one thread, on packets that are ready in memory.
void RawEmbree(benchmark::State& state) {
  const PatchMesh mesh = clutter(static_cast<int>(state.range(0)));
  const RayScene scene(mesh.occluders);
  const HemisphereRays rays = all_rays(mesh, 1024);
  constexpr std::size_t width = 16;
  std::vector<RTCRayHit16> packets(rays.origins.size() / width);
  alignas(64) int valid[width];
  for (int& lane : valid) lane = -1;
  for (std::size_t k = 0; k < packets.size() * width; ++k) {
    RTCRayHit16& packet = packets[k / width];
    const std::size_t lane = k % width;
    const Vec3 origin = (rays.origins[k] - scene.centre()) * scene.scale() + 2e-7 * rays.normals[k];
    packet.ray.org_x[lane] = static_cast<float>(origin[0]);
    packet.ray.org_y[lane] = static_cast<float>(origin[1]);
    packet.ray.org_z[lane] = static_cast<float>(origin[2]);
    packet.ray.dir_x[lane] = static_cast<float>(rays.directions[k][0]);
    packet.ray.dir_y[lane] = static_cast<float>(rays.directions[k][1]);
    packet.ray.dir_z[lane] = static_cast<float>(rays.directions[k][2]);
    packet.ray.tnear[lane] = 0;
    packet.ray.time[lane] = 0;
    packet.ray.mask[lane] = ~0u;
  }
  auto* embree = static_cast<RTCScene>(scene.embree_scene());
  for (auto _ : state) {
    for (RTCRayHit16& packet : packets) {
      for (std::size_t lane = 0; lane < width; ++lane) {
        packet.ray.tfar[lane] = std::numeric_limits<float>::infinity();
        packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      }
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect16(valid, embree, &context, &packet);
    }
    benchmark::DoNotOptimize(packets.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * packets.size() * width));
}

/// RayScene::intersect, one thread, on the same rays in the same order.
void Intersect(benchmark::State& state) {
  const PatchMesh mesh = clutter(static_cast<int>(state.range(0)));
  const RayScene scene(mesh.occluders);
  const HemisphereRays rays = all_rays(mesh, 1024);
  std::vector<RayScene::Hit> hits(rays.origins.size());
  for (auto _ : state) {
    scene.intersect(rays.origins, rays.normals, rays.directions, hits);
    benchmark::DoNotOptimize(hits.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * rays.origins.size()));
}

/// The whole of find_enclosures, with all cores.
void FindEnclosures(benchmark::State& state) {
  PatchMesh mesh = clutter(static_cast<int>(state.range(0)));
  // a lid that is missing, so that rays decide
  mesh.occluders.triangles.resize(mesh.occluders.triangles.size() - 2);
  const RayScene scene(mesh.occluders);
  std::int64_t rays = 0;
  for (auto _ : state) rays += find_enclosures(mesh, scene, 1024).rays;
  state.SetItemsProcessed(rays);
}

BENCHMARK(RawEmbree)->Arg(1)->Arg(3)->Arg(8)->Unit(benchmark::kMillisecond);
BENCHMARK(Intersect)->Arg(1)->Arg(3)->Arg(8)->Unit(benchmark::kMillisecond);
BENCHMARK(FindEnclosures)
    ->Arg(1)
    ->Arg(3)
    ->Arg(8)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace luxel
