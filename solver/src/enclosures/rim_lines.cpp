#include "enclosures/rim_lines.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

// How far beside a rim a line passes, in working units: just what rays resolve, and as a share of the rim.
constexpr double hair = 4e-7;
constexpr double share_of_rim = 0.3;

// Before it is looked through, a point must be free this far along the line, in working units: a neighbour
// that fills a crack, or that the rim stands on, is met within.
constexpr double run_up = 1e-5;

// A ray that leaves a sheet over its rim keeps this far above it, in working units, of which RayScene adds
// 2e-7 itself: over cracks that count as touching (4e-7), and below a sheet that leaves a slit of 7e-7 to it.
constexpr double height_over_sheet = 3e-7;

constexpr int directions_a_point = 16;
constexpr int places_over_a_rim = 4;
constexpr std::uint64_t rim_stream = 0x72696d206c696e65;

class Looker {
 public:
  Looker(const PatchMesh& mesh, const RayScene& scene, const PatchLocator& locator, UnionFind& sets,
         std::vector<char>& leaks)
      : mesh_(mesh), scene_(scene), locator_(locator), sets_(sets), leaks_(leaks) {}

  /// Looks both ways along the line through `point` (working coordinates).
  void look(const Vec3& point, const Vec3& direction) {
    if (!free_at(point, direction)) return;
    const int ahead = patch_seen(point, direction), behind = patch_seen(point, -direction);
    if (ahead >= 0 && behind >= 0) {
      sets_.join(ahead, behind);
    } else if (ahead >= 0 || behind >= 0) {
      std::atomic_ref(leaks_[std::max(ahead, behind)]).store(1, std::memory_order_relaxed);
    }
  }

  /// Looks from a side of a sheet out over its rim: what the light in a slit beside the rim meets there.
  void look_over(int triangle, const Vec3& point, const Vec3& normal, const Vec3& off, bool front) {
    const int patch = locator_.patch_at(triangle, front, world(point));
    if (patch < 0) return;
    const Vec3 origin = world(point + height_over_sheet * normal);
    RayScene::Hit hit;
    scene_.intersect({&origin, 1}, {&normal, 1}, {&off, 1}, {&hit, 1}, RayScene::Look::once);
    const int seen =
        hit.primitive < 0 ? -1 : locator_.patch_at(hit.primitive, hit.front, origin + hit.distance * off);
    if (seen >= 0) {
      sets_.join(patch, seen);
    } else {
      std::atomic_ref(leaks_[patch]).store(1, std::memory_order_relaxed);
    }
  }

 private:
  Vec3 world(const Vec3& point) const { return point / scene_.scale() + scene_.centre(); }

  RayScene::Hit shoot(const Vec3& origin, const Vec3& direction) const {
    RayScene::Hit hit;
    scene_.intersect({&origin, 1}, {&direction, 1}, {&direction, 1}, {&hit, 1}, RayScene::Look::once);
    return hit;
  }

  bool free_at(const Vec3& point, const Vec3& direction) const {
    const RayScene::Hit hit = shoot(world(point - run_up * direction), direction);
    return hit.primitive < 0 || hit.distance * scene_.scale() > 2 * run_up;
  }

  /// The patch whose front ends the ray; -1 where it escapes or meets a back.
  int patch_seen(const Vec3& point, const Vec3& direction) const {
    const Vec3 origin = world(point);
    const RayScene::Hit hit = shoot(origin, direction);
    if (hit.primitive < 0) return -1;
    return locator_.patch_at(hit.primitive, hit.front, origin + hit.distance * direction);
  }

  const PatchMesh& mesh_;
  const RayScene& scene_;
  const PatchLocator& locator_;
  UnionFind& sets_;
  std::vector<char>& leaks_;
};

}  // namespace

std::vector<char> look_through_rims(const PatchMesh& mesh, const TriangleSoup& soup,
                                    const std::vector<Rim>& rims, const RayScene& scene,
                                    const PatchLocator& locator, UnionFind& sets) {
  std::vector<char> leaks(mesh.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rims.size(), 8), [&](const auto& range) {
    Looker looker(mesh, scene, locator, sets, leaks);
    for (std::size_t r = range.begin(); r < range.end(); ++r) {
      const Rim& rim = rims[r];
      const Vec3 from = soup.vertices[rim.from], to = soup.vertices[rim.to];
      const Vec3 normal = (soup.corner(rim.triangle, 1) - soup.corner(rim.triangle, 0))
                              .cross(soup.corner(rim.triangle, 2) - soup.corner(rim.triangle, 0))
                              .normalized();
      const double length = (to - from).norm();
      if (!(length > 0)) continue;
      // counter-clockwise, the sheet lies left of the edge
      const Vec3 along = (to - from) / length, off = along.cross(normal);
      for (int k = 0; k < places_over_a_rim; ++k) {
        const Vec3 inside = from + (k + 0.5) / places_over_a_rim * length * along - 2 * hair * off;
        looker.look_over(rim.triangle, inside, normal, off, true);
        looker.look_over(rim.triangle, inside, -normal, off, false);
      }
      const OwenSobol4 sequence(mixed_seed(rim_stream, r));
      for (int k = 0; k < directions_a_point; ++k) {
        const auto [place, height, azimuth, unused] = sequence(k);
        const double angle = 2 * std::numbers::pi * azimuth, cosine = 0.2 + 0.8 * height;
        const double sine = std::sqrt(1 - cosine * cosine);
        const Vec3 direction = cosine * normal + sine * (std::cos(angle) * along + std::sin(angle) * off);
        const Vec3 beside = from + (0.1 + 0.8 * place) * length * along;
        looker.look(beside + hair * off, direction);
        looker.look(beside + share_of_rim * length * off, direction);
      }
    }
  });
  return leaks;
}

}  // namespace luxel
