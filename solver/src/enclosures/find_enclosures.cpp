#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>
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

// The error of these nets falls as rays^-0.65 or faster (measured: -0.67 to -0.76 behind edges).
constexpr double convergence_order = 0.65;

// Stream of these rays among all that are seeded by patch.
constexpr std::uint64_t enclosure_stream = 0x656e636c6f737572;

// Rays of a sliver start from points drawn in towards its centroid: what they miss at its ends may change a
// share by so much times the share of the way (a sliver of 1e-5: 0.05).
constexpr double error_of_drawing_in = 0.1;

enum class Met { front, back, nothing };

/// How far rays keep off the outline of their patch [m].
double margin_of(const RayScene& occluders) {
  return outline_margin / occluders.scale();
}

/// What rays from one patch met, in order; joins the patch with those it sees.
std::vector<Met> look_around(const PatchMesh& mesh, const RayScene& occluders, const PatchLocator& locator,
                             int patch, int count, UnionFind& sets) {
  std::vector<Met> met(count);
  const auto look = [&](const HemisphereRays& rays, std::span<const int> places, RayScene::Look how) {
    const std::size_t some = rays.origins.size();
    std::vector<RayScene::Hit> hits(some);
    occluders.intersect(rays.origins, rays.normals, rays.directions, hits, how);
    std::vector<Vec3> points(some);
    for (std::size_t k = 0; k < some; ++k)
      points[k] = rays.origins[k] + hits[k].distance * rays.directions[k];
    const std::vector<int> seen = locator.patches_at(hits, points);
    for (std::size_t k = 0; k < some; ++k) {
      met[places.empty() ? k : places[k]] = seen[k] >= 0             ? Met::front
                                            : hits[k].primitive >= 0 ? Met::back
                                                                     : Met::nothing;
      if (seen[k] >= 0) sets.join(patch, seen[k]);
    }
  };
  const HemisphereRays rays =
      hemisphere_rays(mesh, patch, count, mixed_seed(enclosure_stream, patch), margin_of(occluders));
  look(rays, {}, RayScene::Look::once);

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
  if (!places.empty()) look(lost, places, RayScene::Look::twice);
  return met;
}

// Variance of a share p over p (1 - p) rays^(-2 order), measured at the mouth of the Cornell box.
constexpr double usual_variance = 0.36;

// Rays below which a count is taken as independent events.
constexpr double few_rays = 16;

/// What the rays of one patch met, as shares; the error is the standard error of their sum, from the scatter
/// between runs.
struct Shares {
  double open = 0, back = 0, error = 0;
};

Shares measured(const std::vector<Met>& met) {
  const std::size_t count = met.size();
  std::array<double, runs> lost{}, total{};
  Shares shares;
  for (std::size_t k = 0; k < count; ++k) {
    shares.open += met[k] == Met::nothing;
    shares.back += met[k] == Met::back;
    lost[k * runs / count] += met[k] != Met::front;
    total[k * runs / count] += 1;
  }
  const double mean = (shares.open + shares.back) / static_cast<double>(count);
  double squares = 0;
  for (int r = 0; r < runs; ++r) squares += std::pow(lost[r] / total[r] - mean, 2);
  shares.open /= static_cast<double>(count);
  shares.back /= static_cast<double>(count);
  // the scatter of so few runs may be small by chance: averaged with what is usual for such a share
  const double scattered = squares / (runs - 1) * std::pow(runs, -2 * convergence_order);
  const double usual = usual_variance * mean * (1 - mean) * std::pow(count, -2 * convergence_order);
  // a net is no better than chance at what only a few of its rays meet
  const bool rare = std::min(mean, 1 - mean) * static_cast<double>(count) < few_rays;
  const double by_chance = mean * (1 - mean) / static_cast<double>(count);
  shares.error = std::sqrt(rare ? by_chance : (scattered + usual) / 2);
  return shares;
}

/// Rays for an error so many times smaller, as a power of two times `rays`.
int rays_needed(int rays, double times) {
  constexpr int most_doublings = 6;
  const double doublings = std::ceil(std::log2(times) / convergence_order);
  return rays << static_cast<int>(std::clamp(doublings, 1.0, static_cast<double>(most_doublings)));
}

/// The most rays that one patch may have for all to have no more than `most`: a power of two times `rays`.
int largest_share(const std::vector<int>& wanted, int rays, std::int64_t most) {
  int each = rays;
  while (each < (1 << 30)) {
    std::int64_t total = 0;
    for (int w : wanted) total += std::min(w, 2 * each);
    if (total > most) break;
    each *= 2;
    if (std::all_of(wanted.begin(), wanted.end(), [&](int w) { return w <= each; })) break;
  }
  return each;
}

}  // namespace

void measure_shares(Enclosures& enclosures, const PatchMesh& mesh, const RayScene& occluders, double accuracy,
                    std::int64_t most_rays, int rays_per_patch, const Progress& progress) {
  if (!(accuracy > 0)) throw std::invalid_argument("measure_shares: the accuracy must be above 0");
  std::vector<int> loose;
  std::vector<int> wanted;
  for (int i = 0; i < mesh.size(); ++i) {
    if (enclosures.enclosure_closed[enclosures.enclosure[i]] || enclosures.share_error[i] <= accuracy)
      continue;
    loose.push_back(i);
    wanted.push_back(rays_needed(rays_per_patch, enclosures.share_error[i] / accuracy));
  }
  const int count = static_cast<int>(loose.size());
  const int each = largest_share(wanted, rays_per_patch, most_rays);
  if (count == 0 || each <= rays_per_patch) return;
  const PatchLocator locator(mesh);
  UnionFind sets(mesh.size());
  StageProgress stage(progress, "sky", count);
  std::atomic<std::int64_t> rays = 0;
  tbb::parallel_for(tbb::blocked_range<int>(0, count, 16), [&](const tbb::blocked_range<int>& range) {
    if (stage.cancelled()) return;
    for (int k = range.begin(); k < range.end(); ++k) {
      const int i = loose[k], asked = std::min(wanted[k], each);
      const Shares shares = measured(look_around(mesh, occluders, locator, i, asked, sets));
      rays += asked;
      enclosures.share_rays[i] = asked;
      enclosures.open_share[i] = shares.open;
      enclosures.back_share[i] = shares.back;
      const bool unanimous = shares.open + shares.back == 0 || shares.open + shares.back == 1;
      enclosures.share_error[i] =
          unanimous ? 1.0 / asked
                    : shares.error + error_of_drawing_in * drawn_in(mesh, i, margin_of(occluders));
    }
    stage.add(range.size());
  });
  stage.finish();
  enclosures.rays += rays;
}

Enclosures find_enclosures(const PatchMesh& mesh, const RayScene& occluders, int rays_per_patch,
                           const Progress& progress, double share_accuracy) {
  if (rays_per_patch < 2 * runs)
    throw std::invalid_argument("find_enclosures: needs 16 rays a patch or more");
  const int size = mesh.size();
  Enclosures result;
  result.open_share.assign(size, 0.0);
  result.back_share.assign(size, 0.0);
  result.share_error.assign(size, 0.0);
  result.share_rays.assign(size, 0);

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
    std::atomic<std::int64_t> rays = 0;
    tbb::parallel_for(tbb::blocked_range<int>(0, doubts, 16), [&](const tbb::blocked_range<int>& range) {
      if (stage.cancelled()) return;
      for (int k = range.begin(); k < range.end(); ++k) {
        const int i = doubtful[k];
        Shares shares = measured(look_around(mesh, occluders, locator, i, rays_per_patch, sets));
        rays += rays_per_patch;
        result.share_rays[i] = rays_per_patch;
        if (share_accuracy > 0 && shares.error > share_accuracy) {
          const int more = rays_needed(rays_per_patch, shares.error / share_accuracy);
          shares = measured(look_around(mesh, occluders, locator, i, more, sets));
          rays += more;
          result.share_rays[i] = more;
        }
        result.open_share[i] = shares.open;
        result.back_share[i] = shares.back;
        result.share_error[i] = shares.error;
      }
      stage.add(range.size());
    });
    stage.finish();
    result.rays = rays;
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
  for (int i = 0; i < size; ++i) {
    if (result.enclosure_closed[result.enclosure[i]]) continue;
    const double share = result.open_share[i] + result.back_share[i];
    if (share == 0 || share == 1) {
      result.share_error[i] = 1.0 / rays_per_patch;  // that all rays agree is no proof
    } else {
      result.share_error[i] += error_of_drawing_in * drawn_in(mesh, i, margin_of(occluders));
    }
  }
  result.closed = size > 0 && std::all_of(result.enclosure_closed.begin(), result.enclosure_closed.end(),
                                          [](char closed) { return closed != 0; });
  return result;
}

}  // namespace luxel
