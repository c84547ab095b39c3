#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "enclosures/cells.h"
#include "enclosures/hemisphere_rays.h"
#include "enclosures/rim_lines.h"
#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "enclosures/union_find.h"
#include "luxel/enclosures.h"
#include "patch_locator.h"
#include "sampling/owen_sobol.h"
#include "stage_progress.h"

namespace luxel {

namespace {

// Origins keep this share of the diagonal off the outline of their patch: above what float moves them (1e-7).
constexpr double outline_margin = 1e-6;

// Runs of the sequence whose scatter gives the standard error; each is a net of its own.
constexpr int runs = 8;

// Stream of these rays among all that are seeded by patch.
constexpr std::uint64_t enclosure_stream = 0x656e636c6f737572;

enum class Met { front, back, nothing };

/// What rays from one patch met, in order; joins the patch with those it sees.
std::vector<Met> look_around(const PatchMesh& mesh, const RayScene& occluders, const PatchLocator& locator,
                             int patch, int count, UnionFind& sets) {
  const double margin = outline_margin / occluders.scale();
  const HemisphereRays rays =
      hemisphere_rays(mesh, patch, count, mixed_seed(enclosure_stream, patch), margin);
  std::vector<RayScene::Hit> hits(count);
  occluders.intersect(rays.origins, rays.normals, rays.directions, hits, RayScene::Look::once);
  std::vector<Met> met(count);
  const auto classify = [&](int k) {
    const RayScene::Hit& hit = hits[k];
    if (hit.primitive < 0) return Met::nothing;
    const Vec3 point = rays.origins[k] + hit.distance * rays.directions[k];
    const int seen = locator.patch_at(hit.primitive, hit.front, point);
    if (seen < 0) return Met::back;
    sets.join(patch, seen);
    return Met::front;
  };
  for (int k = 0; k < count; ++k) met[k] = classify(k);

  // those that met no front are looked at again together
  HemisphereRays lost;
  std::vector<int> places;
  for (int k = 0; k < count; ++k) {
    if (met[k] == Met::front) continue;
    places.push_back(k);
    lost.origins.push_back(rays.origins[k]);
    lost.normals.push_back(rays.normals[k]);
    lost.directions.push_back(rays.directions[k]);
  }
  std::vector<RayScene::Hit> second(places.size());
  occluders.intersect(lost.origins, lost.normals, lost.directions, second, RayScene::Look::twice);
  for (std::size_t k = 0; k < places.size(); ++k) {
    hits[places[k]] = second[k];
    met[places[k]] = classify(places[k]);
  }
  return met;
}

/// The cell that each patch looks into; -1 where its polygon's side bounds several.
std::vector<int> cells_of_patches(const PatchMesh& mesh, const Cells& cells) {
  const Occluders& occluders = mesh.occluders;
  constexpr int none = -2, several = -1;
  std::vector<std::array<int, 2>> of_polygon(occluders.polygon_count, {none, none});
  std::vector<Vec3> normals(occluders.polygon_count, Vec3::Zero());
  for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
    const int p = occluders.polygons[t];
    const auto& [a, b, c] = occluders.triangles[t];
    const Vec3& origin = occluders.vertices[a];
    normals[p] += (occluders.vertices[b] - origin).cross(occluders.vertices[c] - origin);
    for (int side = 0; side < 2; ++side) {
      int& known = of_polygon[p][side];
      const int cell = cells.cell[2 * t + side];
      known = known == none || known == cell ? cell : several;
    }
  }
  std::vector<int> result(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) {
    const int p = mesh.polygons[i];
    result[i] = std::max(several, of_polygon[p][mesh.normals[i].dot(normals[p]) > 0 ? 0 : 1]);
  }
  return result;
}

/// Standard error of the share of rays that met no front, from the scatter between runs.
double share_error(const std::vector<Met>& met) {
  std::array<double, runs> lost{}, total{};
  for (std::size_t k = 0; k < met.size(); ++k) {
    lost[k * runs / met.size()] += met[k] != Met::front;
    total[k * runs / met.size()] += 1;
  }
  double mean = 0, squares = 0;
  for (int r = 0; r < runs; ++r) mean += lost[r] / total[r] / runs;
  for (int r = 0; r < runs; ++r) squares += std::pow(lost[r] / total[r] - mean, 2);
  return std::sqrt(squares / (runs - 1) / runs);
}

}  // namespace

Enclosures find_enclosures(const PatchMesh& mesh, const RayScene& occluders, int rays_per_patch,
                           const Progress& progress) {
  if (rays_per_patch < 2 * runs)
    throw std::invalid_argument("find_enclosures: needs 16 rays a patch or more");
  const int size = mesh.size();
  Enclosures result;
  result.open_share.assign(size, 0.0);
  result.back_share.assign(size, 0.0);
  result.share_error.assign(size, 0.0);

  const TriangleSoup soup(mesh.occluders, occluders);
  const Shells shells = find_shells(soup);
  const Cells cells = find_cells(soup, shells, lit_sides(mesh), occluders);
  const std::vector<int> cell = cells_of_patches(mesh, cells);
  const auto proof = [&](int i) { return cell[i] < 0 ? Proof::none : cells.proof[cell[i]]; };

  // patches of a closed cell see each other, if not at once then by way of others
  UnionFind sets(size);
  std::vector<int> first_of_cell(cells.count, -1);
  for (int i = 0; i < size; ++i) {
    if (proof(i) != Proof::closed) continue;
    int& first = first_of_cell[cell[i]];
    if (first < 0) first = i;
    sets.join(first, i);
  }

  std::vector<int> doubtful;
  for (int i = 0; i < size; ++i) {
    if (proof(i) != Proof::closed) doubtful.push_back(i);
  }
  const int doubts = static_cast<int>(doubtful.size());
  std::vector<char> leaks(size, 0);
  if (doubts > 0) {
    const PatchLocator locator(mesh);
    StageProgress stage(progress, "enclosures", doubts);
    tbb::parallel_for(tbb::blocked_range<int>(0, doubts, 16), [&](const tbb::blocked_range<int>& range) {
      if (stage.cancelled()) return;
      for (int k = range.begin(); k < range.end(); ++k) {
        const int i = doubtful[k];
        const std::vector<Met> met = look_around(mesh, occluders, locator, i, rays_per_patch, sets);
        const auto open = std::count(met.begin(), met.end(), Met::nothing);
        const auto back = std::count(met.begin(), met.end(), Met::back);
        if (open + back == 0) continue;
        result.open_share[i] = static_cast<double>(open) / rays_per_patch;
        result.back_share[i] = static_cast<double>(back) / rays_per_patch;
        result.share_error[i] = share_error(met);
      }
      stage.add(range.size());
    });
    stage.finish();
    result.rays = static_cast<std::int64_t>(doubts) * rays_per_patch;
    leaks = look_through_rims(mesh, soup, shells.rims, occluders, locator, sets);
  }

  result.enclosure.resize(size);
  for (int i = 0; i < size; ++i) {
    const int root = sets.root(i);
    if (root == i) {
      result.enclosure[i] = result.count++;
      result.enclosure_closed.push_back(1);
    } else {
      result.enclosure[i] = result.enclosure[root];
    }
    const bool lost = result.open_share[i] + result.back_share[i] > 0;
    if (lost || leaks[i] || proof(i) == Proof::open) result.enclosure_closed[result.enclosure[i]] = 0;
  }
  // none of the rays is no proof of nothing where the enclosure is open
  for (int i = 0; i < size; ++i) {
    const bool lost = result.open_share[i] + result.back_share[i] > 0;
    if (!lost && !result.enclosure_closed[result.enclosure[i]]) result.share_error[i] = 1.0 / rays_per_patch;
  }
  result.closed = size > 0 && std::all_of(result.enclosure_closed.begin(), result.enclosure_closed.end(),
                                          [](char closed) { return closed != 0; });
  return result;
}

}  // namespace luxel
