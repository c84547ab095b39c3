#include "operator_error/probe.h"

#include <algorithm>
#include <numbers>

#include "enclosures/hemisphere_rays.h"
#include "operator_error/patch_square.h"
#include "sampling/owen_sobol.h"

namespace luxel {

namespace {

constexpr std::uint64_t lamp_stream = 0x70726f62;

// Emitters that cover more of the surface are met by the rays over the hemisphere often enough.
constexpr double largest_share_apart = 0.25;

// As shares of the scene's diagonal: how far origins keep off the outline of their patch, above the rounding
// of an origin in float (6e-8); and how close before a lamp something must stand to count as the lamp.
constexpr double outline_margin = 1e-6, lamp_margin = 2e-6;

}  // namespace

Probe::Probe(const PatchMesh& mesh, const RayScene& occluders, const PatchField& emission,
             const PatchField& radiosity, std::span<const int> order, std::span<const std::int32_t> part,
             int parts)
    : mesh_(mesh),
      occluders_(occluders),
      emission_(emission),
      radiosity_(radiosity),
      part_(part),
      parts_(parts),
      lamps_(mesh, emission, order, largest_share_apart),
      locator_(mesh) {}

// A ray brings U = B - E from where it ends, and E there with the weight of the balance heuristic: the
// density of rays of one kind, in solid angle, over that of both.
Probe::Look Probe::look(int patch, int count, std::uint64_t seed) const {
  Look look;
  look.irradiance = Eigen::RowVectorXd::Zero(radiosity_.cols());
  look.met.assign(parts_, 0);
  const LampPoints::View lamps(lamps_, patch);
  const bool apart = !lamps.empty();
  const HemisphereRays rays =
      hemisphere_rays(mesh_, patch, count, mixed_seed(seed, patch), outline_margin / occluders_.scale());
  std::vector<RayScene::Hit> hits(count);
  occluders_.intersect(rays.origins, rays.normals, rays.directions, hits);
  std::vector<Vec3> points(count);
  for (int k = 0; k < count; ++k) points[k] = rays.origins[k] + hits[k].distance * rays.directions[k];
  const std::vector<int> patches = locator_.patches_at(hits, points);
  for (const int met : patches) {
    if (met < 0) continue;
    __builtin_prefetch(&radiosity_(met, 0));
    __builtin_prefetch(&part_[met]);
  }
  int found = 0;
  for (int k = 0; k < count; ++k) {
    const RayScene::Hit& hit = hits[k];
    const int met = patches[k];
    if (met < 0) continue;
    ++found;
    ++look.met[part_[met]];
    look.irradiance += radiosity_.row(met);
    const double density = apart ? lamps.density(met) : 0;
    if (!(density > 0)) continue;
    const double cosine = mesh_.normals[patch].dot(rays.directions[k]);
    const double lamp_cosine = -mesh_.normals[met].dot(rays.directions[k]);
    const double own = cosine * lamp_cosine / std::numbers::pi;
    const double other = density * hit.distance * hit.distance;
    look.irradiance -= other / (own + other) * emission_.row(met);
  }
  look.irradiance /= count;
  look.row_sum = static_cast<double>(found) / count;
  look.rays = count;
  if (apart) add_lamps(patch, lamps, count, seed, look);
  return look;
}

void Probe::add_lamps(int patch, const LampPoints::View& lamps, int count, std::uint64_t seed,
                      Look& look) const {
  const Vec3& normal = mesh_.normals[patch];
  const PatchSquare square(mesh_, patch);
  const double margin = outline_margin / occluders_.scale();
  const double shrink = drawn_in(mesh_, patch, margin);
  const OwenSobol4 points(mixed_seed(seed ^ lamp_stream, patch));
  std::vector<Vec3> origins, directions;
  std::vector<double> distances, weights;
  std::vector<int> patches;
  for (int k = 0; k < count; ++k) {
    const auto [s, t, u, v] = points(k);
    Vec3 origin = square(s, t);
    origin += shrink * (mesh_.centroids[patch] - origin);
    const LampPoints::Point lamp = lamps.point(u, v);
    const Vec3 way = lamp.at - origin;
    const double distance = way.norm();
    const double cosine = normal.dot(way) / distance, lamp_cosine = -lamp.normal.dot(way) / distance;
    if (!(cosine > 0 && lamp_cosine > 0)) continue;
    origins.push_back(origin);
    directions.push_back(way / distance);
    distances.push_back(distance);
    patches.push_back(lamp.patch);
    const double own = lamp.density * distance * distance;
    const double kernel = cosine * lamp_cosine / std::numbers::pi;
    weights.push_back(kernel / (own + kernel));
  }
  std::vector<RayScene::Hit> hits(origins.size());
  const std::vector<Vec3> normals(origins.size(), normal);
  occluders_.intersect(origins, normals, directions, hits, RayScene::Look::once);
  Eigen::RowVectorXd direct = Eigen::RowVectorXd::Zero(look.irradiance.size());
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const bool hidden =
        hits[k].primitive >= 0 && hits[k].distance < distances[k] - lamp_margin / occluders_.scale();
    if (!hidden) direct += weights[k] * emission_.row(patches[k]);
  }
  look.irradiance += direct / count;
  look.rays += static_cast<std::int64_t>(origins.size());
}

}  // namespace luxel
