#include "patch_locator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace luxel {

namespace {

// A point that misses every outline by less than this share of the diagonal is on the nearest: above the
// rounding of a hit (1e-7), below the smallest features (1e-6).
constexpr double outline_tolerance = 5e-7;

// Cells a patch, about: enough that most cells lie in one patch or two.
constexpr double cells_a_patch = 4;

Vec3 triangle_normal(const Occluders& occluders, int triangle) {
  const auto& [a, b, c] = occluders.triangles[triangle];
  return (occluders.vertices[b] - occluders.vertices[a]).cross(occluders.vertices[c] - occluders.vertices[a]);
}

/// Of any length.
std::vector<Vec3> polygon_normals(const Occluders& occluders) {
  std::vector<Vec3> normals(occluders.polygon_count, Vec3::Zero());
  for (std::size_t t = 0; t < occluders.triangles.size(); ++t) {
    normals[occluders.polygons[t]] += triangle_normal(occluders, static_cast<int>(t));
  }
  return normals;
}

}  // namespace

PatchLocator::PatchLocator(const PatchMesh& mesh)
    : mesh_(mesh),
      sheets_(2 * mesh.occluders.polygon_count),
      coplanar_(mesh.occluders, polygon_normals(mesh.occluders)) {
  if (mesh.size() == 0) return;
  Vec3 low = mesh.centroids[0], high = low;
  for (const Vec3& x : mesh.vertices) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  tolerance_ = outline_tolerance * (high - low).norm();

  const std::vector<Vec3> normals = polygon_normals(mesh.occluders);

  // patches by sheet: counted, then placed
  std::vector<int> sheet_of(mesh.size());
  std::vector<int> starts(sheets_.size() + 1, 0);
  for (int i = 0; i < mesh.size(); ++i) {
    const bool front = mesh.normals[i].dot(normals[mesh.polygons[i]]) > 0;
    sheet_of[i] = 2 * mesh.polygons[i] + (front ? 0 : 1);
    ++starts[sheet_of[i] + 1];
  }
  for (std::size_t s = 0; s < sheets_.size(); ++s) starts[s + 1] += starts[s];
  std::vector<int> order(mesh.size());
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (int i = 0; i < mesh.size(); ++i) order[next[sheet_of[i]]++] = i;

  std::vector<int> patches;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    patches.assign(order.begin() + starts[s], order.begin() + starts[s + 1]);
    if (patches.size() == 1) sheets_[s].first_cell = patches[0];
    if (patches.size() > 1) add_grid(sheets_[s], patches);
  }
}

void PatchLocator::add_grid(Sheet& sheet, const std::vector<int>& patches) {
  const int first = patches[0];
  const auto& corners = mesh_.corners[first];
  Frame frame;
  frame.origin = mesh_.vertices[corners[0]];
  frame.u = (mesh_.vertices[corners[1]] - frame.origin).normalized();
  frame.v = mesh_.normals[first].cross(frame.u);
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::Array2d low(infinity, infinity), high(-infinity, -infinity);
  std::vector<Eigen::Array4d> boxes;  // low, high of each patch in the plane [m]
  for (int patch : patches) {
    Eigen::Array2d patch_low(infinity, infinity), patch_high(-infinity, -infinity);
    for (int k = 0; k < mesh_.corner_count(patch); ++k) {
      const Vec3 x = mesh_.vertices[mesh_.corners[patch][k]] - frame.origin;
      const Eigen::Array2d p(x.dot(frame.u), x.dot(frame.v));
      patch_low = patch_low.min(p);
      patch_high = patch_high.max(p);
    }
    boxes.emplace_back(patch_low[0], patch_low[1], patch_high[0], patch_high[1]);
    low = low.min(patch_low);
    high = high.max(patch_high);
  }
  low -= tolerance_;
  high += tolerance_;
  const Eigen::Array2d extent = high - low;
  const double cell = std::sqrt(extent[0] * extent[1] / (cells_a_patch * patches.size()));
  const double most = 4 * cells_a_patch * patches.size();  // a side, for thin strips
  sheet.nx = static_cast<int>(std::clamp(std::ceil(extent[0] / cell), 1.0, most));
  sheet.ny = static_cast<int>(std::clamp(std::ceil(extent[1] / cell), 1.0, most));
  sheet.first_cell = static_cast<int>(cells_.size());
  sheet.frame = static_cast<int>(frames_.size());
  const Eigen::Array2d inverse = Eigen::Array2d(sheet.nx, sheet.ny) / extent;
  frame.origin += low[0] * frame.u + low[1] * frame.v;
  frame.u *= inverse[0];
  frame.v *= inverse[1];
  frames_.push_back(frame);

  std::vector<std::vector<int>> lists(static_cast<std::size_t>(sheet.nx) * sheet.ny);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Eigen::Array2d from = ((boxes[k].head<2>() - tolerance_ - low) * inverse).floor();
    const Eigen::Array2d to = ((boxes[k].tail<2>() + tolerance_ - low) * inverse).floor();
    for (int j = std::max(0, int(from[1])); j <= std::min(sheet.ny - 1, int(to[1])); ++j) {
      for (int i = std::max(0, int(from[0])); i <= std::min(sheet.nx - 1, int(to[0])); ++i) {
        auto& list = lists[static_cast<std::size_t>(j) * sheet.nx + i];
        if (covers(patches[k], frame, i, j)) {
          list.insert(list.begin(), ~patches[k]);
        } else {
          list.push_back(patches[k]);
        }
      }
    }
  }
  for (const auto& list : lists) {
    cells_.push_back(static_cast<int>(candidates_.size()));
    const bool covered = !list.empty() && list.front() < 0;
    candidates_.insert(candidates_.end(), list.begin(), covered ? list.begin() + 1 : list.end());
  }
  cells_.push_back(static_cast<int>(candidates_.size()));
}

bool PatchLocator::contains(int patch, const Vec3& point) const {
  const auto& corners = mesh_.corners[patch];
  const int count = mesh_.corner_count(patch);
  const Vec3& normal = mesh_.normals[patch];
  const Vec3* from = &mesh_.vertices[corners[count - 1]];
  for (int k = 0; k < count; ++k) {
    const Vec3* to = &mesh_.vertices[corners[k]];
    if (normal.dot((*to - *from).cross(point - *from)) < 0) return false;
    from = to;
  }
  return true;
}

/// Distance of a point in the patch's plane from its outline [m], positive inside.
double PatchLocator::depth(int patch, const Vec3& point) const {
  const auto& corners = mesh_.corners[patch];
  const int count = mesh_.corner_count(patch);
  double depth = std::numeric_limits<double>::infinity();
  for (int k = 0; k < count; ++k) {
    const Vec3& a = mesh_.vertices[corners[k]];
    const Vec3 edge = mesh_.vertices[corners[(k + 1) % count]] - a;
    depth = std::min(depth, mesh_.normals[patch].cross(edge).dot(point - a) / edge.norm());
  }
  return depth;
}

/// Whether the patch covers cell (i, j) of the frame.
bool PatchLocator::covers(int patch, const Frame& frame, int i, int j) const {
  const Vec3 u = frame.u / frame.u.squaredNorm(), v = frame.v / frame.v.squaredNorm();
  const Vec3 corner = frame.origin + i * u + j * v;
  return depth(patch, corner) >= 0 && depth(patch, corner + u) >= 0 && depth(patch, corner + v) >= 0 &&
         depth(patch, corner + u + v) >= 0;
}

int PatchLocator::patch_at(int triangle, bool front, const Vec3& point) const {
  const int polygon = mesh_.occluders.polygons[triangle];
  const int patch = patch_on(sheets_[2 * polygon + (front ? 0 : 1)], point);
  if (patch >= 0) return patch;
  for (const CoplanarSheets::Sheet& sheet : coplanar_.at(polygon, point)) {
    const int other = patch_on(sheets_[2 * sheet.polygon + (front != sheet.opposed ? 0 : 1)], point);
    if (other >= 0) return other;
  }
  return -1;
}

int PatchLocator::patch_on(const Sheet& sheet, const Vec3& point) const {
  std::span<const int> candidates(&sheet.first_cell, sheet.first_cell < 0 ? 0 : 1);
  if (sheet.nx > 0) {
    const Frame& frame = frames_[sheet.frame];
    const Vec3 x = point - frame.origin;
    const int i = std::clamp(static_cast<int>(x.dot(frame.u)), 0, sheet.nx - 1);
    const int j = std::clamp(static_cast<int>(x.dot(frame.v)), 0, sheet.ny - 1);
    const int* cell = &cells_[sheet.first_cell + static_cast<std::size_t>(j) * sheet.nx + i];
    candidates = std::span<const int>(candidates_).subspan(cell[0], cell[1] - cell[0]);
  }
  int nearest = -1;
  double best = -tolerance_;
  for (int candidate : candidates) {
    if (candidate < 0) return ~candidate;
    if (contains(candidate, point)) return candidate;
  }
  for (int candidate : candidates) {
    const double inside = depth(candidate, point);
    if (inside >= best) {
      best = inside;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace luxel
