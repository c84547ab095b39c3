#include "patch_locator.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace luxel {

namespace {

// A point that misses every outline by less than this share of the diagonal is on the nearest: above the
// rounding of a hit (1e-7), below the smallest features (1e-6).
constexpr double outline_tolerance = 5e-7;

// Cells a patch at most, where patches lie far apart.
constexpr double cells_a_patch = 2;

// Patches smaller than the largest of their sheet by more powers of two than this share a grid.
constexpr int most_sizes = 12;

// Look-ups whose memory is on its way at a time.
constexpr int prefetched = 32;

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

/// What a patch takes up in the plane of its sheet [m].
struct PatchLocator::Box {
  int patch;
  Eigen::Array2d low, high;
  int size = 0;  // class of its extents

  Eigen::Array2d extent() const { return high - low; }
  Eigen::Array2d middle() const { return (low + high) / 2; }
};

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

  std::vector<int> with_grids;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (starts[s + 1] - starts[s] == 1) sheets_[s].first = order[starts[s]];
    if (starts[s + 1] - starts[s] > 1) with_grids.push_back(static_cast<int>(s));
  }
  if (with_grids.empty()) return;
  outlines_.resize(mesh.size());
  std::vector<std::vector<Grid>> grids(with_grids.size());
  tbb::parallel_for(std::size_t{0}, with_grids.size(), [&](std::size_t k) {
    const int first = starts[with_grids[k]], end = starts[with_grids[k] + 1];
    grids[k] = grids_of(std::span<const int>(order).subspan(first, end - first), first);
  });
  for (std::size_t k = 0; k < with_grids.size(); ++k) {
    sheets_[with_grids[k]] = {static_cast<int>(grids_.size()), static_cast<int>(grids[k].size())};
    std::move(grids[k].begin(), grids[k].end(), std::back_inserter(grids_));
  }
}

std::vector<PatchLocator::Grid> PatchLocator::grids_of(std::span<const int> patches, int first_outline) {
  const int first = patches[0];
  const Vec3 origin = mesh_.vertices[mesh_.corners[first][0]];
  const Vec3 u = (mesh_.vertices[mesh_.corners[first][1]] - origin).normalized();
  const Vec3 v = mesh_.normals[first].cross(u);
  std::vector<Box> boxes;
  boxes.reserve(patches.size());
  Eigen::Array2d largest = Eigen::Array2d::Zero();
  for (const int patch : patches) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{patch, {infinity, infinity}, {-infinity, -infinity}};
    for (int k = 0; k < mesh_.corner_count(patch); ++k) {
      const Vec3& x = mesh_.vertices[mesh_.corners[patch][k]];
      const Eigen::Array2d p(x.dot(u), x.dot(v));
      box.low = box.low.min(p);
      box.high = box.high.max(p);
    }
    box.low -= tolerance_;
    box.high += tolerance_;
    largest = largest.max(box.extent());
    boxes.push_back(box);
  }
  const auto smaller = [](double whole, double part) {
    return std::min(most_sizes, static_cast<int>(std::log2(whole / part)));
  };
  std::vector<int> counts((most_sizes + 1) * (most_sizes + 1), 0);
  for (Box& box : boxes) {
    const Eigen::Array2d extent = box.extent();
    box.size = extent[0] > largest[0] / 2 && extent[1] > largest[1] / 2
                   ? 0
                   : smaller(largest[0], extent[0]) * (most_sizes + 1) + smaller(largest[1], extent[1]);
    ++counts[box.size];
  }
  if (counts[0] < static_cast<int>(boxes.size())) {
    std::stable_sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.size < b.size; });
  }
  std::vector<Grid> grids;
  std::size_t begin = 0;
  for (const int count : counts) {
    if (count == 0) continue;
    grids.push_back(grid_of(std::span<const Box>(boxes).subspan(begin, count), u, v,
                            first_outline + static_cast<int>(begin)));
    begin += count;
  }
  return grids;
}

PatchLocator::Grid PatchLocator::grid_of(std::span<const Box> boxes, const Vec3& u, const Vec3& v,
                                         int first_outline) {
  Eigen::Array2d low = boxes[0].middle(), high = low, cell = Eigen::Array2d::Zero();
  for (const Box& box : boxes) {
    low = low.min(box.middle());
    high = high.max(box.middle());
    cell = cell.max(box.extent());
  }
  // middles keep off the grid's edge by half a cell
  const auto most = cells_a_patch * static_cast<double>(boxes.size());
  const Eigen::Array2d needed = (high - low) / cell + 1;
  if (needed.prod() > most) cell *= std::sqrt(needed.prod() / most);
  Grid grid;
  low -= cell / 2;
  const Eigen::Array2d counts = ((high - low) / cell).floor() + 1;
  // a strip would have many cells still
  grid.nx = static_cast<int>(std::min(counts[0], most + 1));
  grid.ny = static_cast<int>(std::min(counts[1], most + 1));
  cell = cell.max((high - low) / (Eigen::Array2d(grid.nx, grid.ny) - 0.5));
  grid.origin = low[0] * u + low[1] * v;
  grid.u = u / cell[0];
  grid.v = v / cell[1];
  grid.cells.assign(static_cast<std::size_t>(grid.nx) * grid.ny + 1, 0);

  std::vector<int> cell_of(boxes.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const Eigen::Array2d at = (boxes[k].middle() - low) / cell;
    const int i = std::clamp(static_cast<int>(at[0]), 0, grid.nx - 1);
    const int j = std::clamp(static_cast<int>(at[1]), 0, grid.ny - 1);
    cell_of[k] = j * grid.nx + i;
    ++grid.cells[cell_of[k]];
  }
  int end = first_outline;
  for (int& place : grid.cells) place = end += place;
  for (std::size_t k = boxes.size(); k-- > 0;) {
    const int place = --grid.cells[cell_of[k]];
    Outline& outline = outlines_[place];
    const int patch = outline.patch = boxes[k].patch;
    const Eigen::Array2d middle(cell_of[k] % grid.nx + 0.5, cell_of[k] / grid.nx + 0.5);
    const int count = mesh_.corner_count(patch);
    for (int c = 0; c < 4; ++c) {
      const Vec3& x = mesh_.vertices[mesh_.corners[patch][std::min(c, count - 1)]];
      const Eigen::Array2d at = (Eigen::Array2d(x.dot(u), x.dot(v)) - low) / cell - middle;
      outline.x[c] = static_cast<float>(at[0]);
      outline.y[c] = static_cast<float>(at[1]);
    }
  }
  return grid;
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

Eigen::Array2i PatchLocator::Grid::first_cell(const Eigen::Array2d& at) const {
  return (at - 0.5).floor().cast<int>().max(0).min(Eigen::Array2i(nx, ny) - 1);
}

Eigen::Array2i PatchLocator::Grid::own_cell(const Eigen::Array2d& at) const {
  return at.floor().cast<int>().max(0).min(Eigen::Array2i(nx, ny) - 1);
}

Eigen::Array2i PatchLocator::Grid::last_cell(const Eigen::Array2d& at) const {
  return (at + 0.5).floor().cast<int>().max(0).min(Eigen::Array2i(nx, ny) - 1);
}

int PatchLocator::patch_at(int triangle, bool front, const Vec3& point) const {
  const int patch = patch_on(sheet_of(triangle, front), point);
  if (patch >= 0) return patch;
  for (const CoplanarSheets::Sheet& sheet : coplanar_.at(mesh_.occluders.polygons[triangle], point)) {
    const int other = patch_on(sheets_[2 * sheet.polygon + (front != sheet.opposed ? 0 : 1)], point);
    if (other >= 0) return other;
  }
  return -1;
}

int PatchLocator::patch_on(const Sheet& sheet, const Vec3& point) const {
  const auto near = [&](const Grid& grid, auto&& visit) {
    const Eigen::Array2d at = grid.at(point);
    const auto visit_cell = [&](int i, int j) {
      const int* cell = grid.cell(i, j);
      const auto px = static_cast<float>(at[0] - i - 0.5), py = static_cast<float>(at[1] - j - 0.5);
      for (int k = cell[0]; k < cell[1]; ++k) {
        if (visit(outlines_[k], px, py)) return outlines_[k].patch;
      }
      return -1;
    };
    // regular patches stand in the cell that the point lies in
    const Eigen::Array2i own = grid.own_cell(at);
    if (const int patch = visit_cell(own[0], own[1]); patch >= 0) return patch;
    const Eigen::Array2i from = grid.first_cell(at), to = grid.last_cell(at);
    for (int j = from[1]; j <= to[1]; ++j) {
      for (int i = from[0]; i <= to[0]; ++i) {
        if (i == own[0] && j == own[1]) continue;
        if (const int patch = visit_cell(i, j); patch >= 0) return patch;
      }
    }
    return -1;
  };
  const auto holds = [](const Outline& outline, float px, float py) {
    const Eigen::Map<const Eigen::Array4f> x(outline.x), y(outline.y);
    const Eigen::Array4f next_x(x[1], x[2], x[3], x[0]), next_y(y[1], y[2], y[3], y[0]);
    return ((next_x - x) * (py - y) - (next_y - y) * (px - x)).minCoeff() >= 0;
  };
  for (int g = 0; g < sheet.count; ++g) {
    const int found = near(grids_[sheet.first + g], holds);
    if (found >= 0) return found;
  }
  int nearest = -1;
  double best = -tolerance_;
  const auto compare = [&](int patch) {
    const double inside = depth(patch, point);
    if (inside < best) return;
    best = inside;
    nearest = patch;
  };
  if (sheet.count == 0 && sheet.first >= 0) compare(sheet.first);
  for (int g = 0; g < sheet.count; ++g) {
    near(grids_[sheet.first + g], [&](const Outline& outline, float, float) {
      compare(outline.patch);
      return false;
    });
  }
  return nearest;
}

std::vector<int> PatchLocator::patches_at(std::span<const RayScene::Hit> hits,
                                          std::span<const Vec3> points) const {
  if (points.size() != hits.size()) {
    throw std::invalid_argument("PatchLocator::patches_at: hits and points differ in number");
  }
  std::vector<int> patches(hits.size(), -1);
  std::array<const int*, prefetched> cells;  // those that the points lie in
  for (std::size_t begin = 0; begin < hits.size(); begin += prefetched) {
    const std::size_t count = std::min<std::size_t>(prefetched, hits.size() - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const RayScene::Hit& hit = hits[begin + k];
      cells[k] = nullptr;
      if (hit.primitive < 0) continue;
      const Sheet& sheet = sheet_of(hit.primitive, hit.front);
      if (sheet.count == 0) continue;
      const Grid& grid = grids_[sheet.first];
      const Eigen::Array2i own = grid.own_cell(grid.at(points[begin + k]));
      cells[k] = grid.cell(own[0], own[1]);
      __builtin_prefetch(cells[k]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (cells[k]) __builtin_prefetch(&outlines_[std::min<std::size_t>(*cells[k], outlines_.size() - 1)]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const RayScene::Hit& hit = hits[begin + k];
      if (hit.primitive >= 0) patches[begin + k] = patch_at(hit.primitive, hit.front, points[begin + k]);
    }
  }
  return patches;
}

}  // namespace luxel
