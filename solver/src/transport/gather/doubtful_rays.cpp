#include <Eigen/Geometry>

#include "enclosures/hemisphere_rays.h"
#include "sampling/owen_sobol.h"
#include "transport/gather/gather_rays.h"
#include "transport/gather/patch_frame.h"

// What of GatherRays puts right the rays that its map and Embree leave in doubt.

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Lost rays of a packet that are asked again before the rest is believed, unless one in so many proves wrong.
constexpr int lost_for_certain = 4, wrong_among = 8;

// Fresh directions tried for a ray of a closed enclosure that is lost for good: one in 10^6 of the rays
// beside a crack, at most.
constexpr int replacements = 8;

constexpr std::uint64_t replacement_stream = 0x7265706c;

}  // namespace

bool GatherRays::Certainty::enough() const {
  return lost >= lost_for_certain && lost > wrong_among * found;
}

const PatchLocator& GatherRays::locator() const {
  std::call_once(locator_made_, [this] { locator_ = std::make_unique<PatchLocator>(mesh_); });
  return *locator_;
}

void GatherRays::settle(const GatherOperator::Packet& packet, int first,
                        std::span<const DoubtfulRay> doubtful, std::uint32_t* met,
                        Certainty& certainty) const {
  int asked = 0;
  for (const DoubtfulRay& ray : doubtful) {
    const int patch = packet[ray.lane];
    const bool closed = enclosures_[patch] >= 0;
    if (ray.lost && !closed && certainty.enough()) continue;
    std::uint32_t& end = met[static_cast<std::size_t>(ray.ray) * lanes + ray.lane];
    end = settled(patch, ray);
    ++asked;
    if (ray.lost) ++(end == static_cast<std::uint32_t>(mesh_.size()) ? certainty.lost : certainty.found);
    if (closed && end == static_cast<std::uint32_t>(mesh_.size())) {
      end = replaced(patch, mixed_seed(seed_ ^ replacement_stream, first + ray.ray));
    }
  }
  asked_twice_ += asked;
}

/// The patch that a ray meets, in double precision; -1 for nothing, or in a closed enclosure for a patch of
/// another.
int GatherRays::patch_met(int patch, const Vec3& origin, const Vec3& direction) const {
  RayScene::Hit hit;
  occluders_.intersect({&origin, 1}, {&mesh_.normals[patch], 1}, {&direction, 1}, {&hit, 1});
  if (hit.primitive < 0) return -1;
  const int met = locator().patch_at(hit.primitive, hit.front, origin + hit.distance * direction);
  if (met < 0) return -1;
  const bool leaked = enclosures_[patch] >= 0 && enclosures_[met] != enclosures_[patch];
  return leaked ? -1 : met;
}

/// The patch at a hit whose texel does not know; -1 as in patch_met().
int GatherRays::patch_hit(int patch, const DoubtfulRay& ray) const {
  const auto& [a, b, c] = mesh_.occluders.triangles[ray.triangle];
  const Vec3& corner = mesh_.occluders.vertices[a];
  const Vec3 point = corner + ray.u * (mesh_.occluders.vertices[b] - corner) +
                     ray.v * (mesh_.occluders.vertices[c] - corner);
  const int met = locator().patch_at(ray.triangle, ray.front, point);
  if (met < 0) return -1;
  return enclosures_[patch] >= 0 && enclosures_[met] != enclosures_[patch] ? -1 : met;
}

std::uint32_t GatherRays::settled(int patch, const DoubtfulRay& ray) const {
  int met = ray.lost ? -1 : patch_hit(patch, ray);
  if (met < 0) {
    const auto vector = [](const float* x) { return Vec3(x[0], x[1], x[2]); };
    Vec3 origin = vector(ray.origin) / occluders_.scale() + occluders_.centre();
    const Vec3& normal = mesh_.normals[patch];
    origin -= normal.dot(origin - mesh_.centroids[patch]) * normal;
    met = patch_met(patch, origin, vector(ray.direction).normalized());
  }
  return static_cast<std::uint32_t>(met >= 0 ? met : mesh_.size());
}

/// What some other ray of the patch meets.
std::uint32_t GatherRays::replaced(int patch, std::uint64_t seed) const {
  const HemisphereRays rays =
      hemisphere_rays(mesh_, patch, replacements, mixed_seed(seed, patch), outline_margin(occluders_));
  for (int k = 0; k < replacements; ++k) {
    const int met = patch_met(patch, rays.origins[k], rays.directions[k]);
    if (met >= 0) return static_cast<std::uint32_t>(met);
  }
  return static_cast<std::uint32_t>(mesh_.size());
}

}  // namespace luxel
