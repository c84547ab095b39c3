#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "luxel/gather_operator.h"
#include "sampling/owen_sobol.h"
#include "stage_progress.h"
#include "transport/gather/lamp_light.h"
#include "transport/gather/shadow_rays.h"

namespace luxel {

namespace {

// Rays of the first look at a lamp; where they agree no more are cast. Penumbrae narrower than a sixteenth of
// a patch can be missed; 32 rays changed no error that could be seen.
constexpr int first_rays = 16;

constexpr std::uint64_t first_stream = 0x6c616d70, second_stream = 0x6c616d71;

// Patches a task.
constexpr int grain = 64;

enum Seen : char { not_facing, hidden, lit, partly };

}  // namespace

DirectLight direct_irradiance(const PatchMesh& mesh, const RayScene& occluders, const PatchField& emission,
                              const GatherOptions& options, const Progress& progress) {
  const GatherPlan plan = gather_plan(mesh, emission, options);
  const int size = mesh.size();
  const std::vector<Lamp> lamps = lamps_of(mesh, emission, occluders);
  const ShadowRays rays(occluders, std::max(first_rays, plan.shadow_rays));
  const double square = occluders.scale() * occluders.scale();
  DirectLight direct;
  direct.irradiance = PatchField::Zero(size, emission.cols());
  StageProgress stage(progress, "direct light",
                      std::max<double>(1, 2.0 * size * static_cast<double>(lamps.size())));
  std::atomic<std::int64_t> cast = 0;
  std::vector<char> touched(size, 0);
  std::vector<Seen> seen(size);
  std::vector<float> share(size);
  std::vector<char> penumbra(mesh.vertices.size());
  const auto each_patch = [&](auto&& visit) {
    tbb::parallel_for(tbb::blocked_range<int>(0, size, grain), [&](const tbb::blocked_range<int>& range) {
      if (stage.cancelled()) return;
      std::int64_t count = 0;
      for (int i = range.begin(); i < range.end(); ++i) count += visit(i);
      cast += count;
      stage.add(range.size());
    });
    stage.finish();
  };
  for (std::size_t l = 0; l < lamps.size(); ++l) {
    const Lamp& lamp = lamps[l];
    each_patch([&](int i) {
      const PatchFrame patch = patch_frame(mesh, i, occluders);
      seen[i] = not_facing;
      if (!faces(patch, lamp)) return 0;
      const int count = is_close(patch, lamp) ? plan.shadow_rays : first_rays;
      const LampView view =
          rays.view(patch, lamp, count, mixed_seed(options.seed ^ first_stream ^ l << 32, i));
      const bool agreed = view.rays > 0 && view.some_lit != view.some_hidden;
      seen[i] = !agreed ? partly : view.some_lit ? lit : hidden;
      share[i] = static_cast<float>(view.share);
      return view.rays;
    });
    // a penumbra reaches into the patches around those where rays found it
    std::fill(penumbra.begin(), penumbra.end(), 0);
    for (int i = 0; i < size; ++i) {
      if (seen[i] != partly) continue;
      for (int k = 0; k < mesh.corner_count(i); ++k) penumbra[mesh.corners[i][k]] = 1;
    }
    each_patch([&](int i) {
      if (seen[i] == not_facing) return 0;
      const PatchFrame patch = patch_frame(mesh, i, occluders);
      int count = 0;
      const auto in_penumbra = [&](int corner) { return corner >= 0 && penumbra[corner]; };
      if (std::any_of(mesh.corners[i].begin(), mesh.corners[i].end(), in_penumbra)) {
        const LampView view =
            rays.view(patch, lamp, plan.shadow_rays, mixed_seed(options.seed ^ second_stream ^ l << 32, i));
        share[i] = static_cast<float>(view.share);
        count = view.rays;
        touched[i] = 1;
      }
      if (share[i] > 0) {
        direct.irradiance.row(i) +=
            share[i] * unoccluded(patch, mesh.areas[i] * square, lamp) * lamp.emission;
      }
      return count;
    });
  }
  direct.rays = cast;
  direct.partly_lit = static_cast<int>(std::count(touched.begin(), touched.end(), 1));
  return direct;
}

}  // namespace luxel
