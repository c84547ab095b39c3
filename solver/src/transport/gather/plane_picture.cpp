#include "transport/gather/plane_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "transport/gather/hit_map.h"

namespace luxel {

namespace {

// Boxes that are tried; more would not get smaller by much.
constexpr std::size_t most_edges_tried = 48;

// A box with more texels than this for each in the polygon is not drawn but asked for.
constexpr double most_emptiness = 16;

// Texels that hold no centre of a patch take a neighbour's, this far: a hit lies within one of the outline.
constexpr int rings = 2;

struct Box {
  Eigen::Array2d low, high;
  double area() const { return (high - low).prod(); }
};

Box box_along(const Occluders& occluders, std::span<const int> triangles, const Vec3& x, const Vec3& y) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box{{infinity, infinity}, {-infinity, -infinity}};
  const Vec3& origin = occluders.vertices[occluders.triangles[triangles[0]][0]];
  for (int t : triangles) {
    for (int corner : occluders.triangles[t]) {
      const Vec3 at = occluders.vertices[corner] - origin;
      const Eigen::Array2d p(at.dot(x), at.dot(y));
      box.low = box.low.min(p);
      box.high = box.high.max(p);
    }
  }
  return box;
}

/// A patch in texels: convex, counter-clockwise or clockwise.
struct Outline {
  std::array<Eigen::Vector2d, 4> corners;
  int count;
  double turn;  // sign

  Outline(const PatchMesh& mesh, int patch, const PlanePicture& picture) : count(mesh.corner_count(patch)) {
    for (int k = 0; k < count; ++k) corners[k] = picture.at(mesh.vertices[mesh.corners[patch][k]]);
    const Eigen::Vector2d a = corners[1] - corners[0], b = corners[2] - corners[0];
    turn = a[0] * b[1] - a[1] * b[0] < 0 ? -1 : 1;
  }
  bool holds(const Eigen::Vector2d& x) const {
    for (int k = 0; k < count; ++k) {
      const Eigen::Vector2d& a = corners[k];
      const Eigen::Vector2d edge = corners[(k + 1) % count] - a;
      if (turn * (edge[0] * (x[1] - a[1]) - edge[1] * (x[0] - a[0])) < 0) return false;
    }
    return true;
  }
  Eigen::Array2i low(double shift) const {
    Eigen::Array2d box = corners[0];
    for (int k = 1; k < count; ++k) box = box.min(corners[k].array());
    return (box + shift).floor().cast<int>();
  }
  Eigen::Array2i high(double shift) const {
    Eigen::Array2d box = corners[0];
    for (int k = 1; k < count; ++k) box = box.max(corners[k].array());
    return (box + shift).floor().cast<int>();
  }
};

/// The point of a texel whose patch it holds: somewhere else in each, evenly along rows, columns and slants,
/// so that along an edge as many texels hold either patch as it has area there, and light across the edge is
/// neither gained nor lost. Golden-ratio and plastic-number sequences (Roberts 2018).
Eigen::Vector2d sample_of(int x, int y) {
  constexpr double golden = 0.6180339887498949, plastic = 0.7548776662466927, square = 0.5698402909980532;
  const auto fraction = [](double at) { return at - std::floor(at); };
  return {x + fraction(plastic * x + golden * y), y + fraction(golden * x + square * y)};
}

/// Empty texels take a full neighbour's patch, nearest first.
void spread(const PlanePicture& picture, std::int32_t empty, std::span<std::int32_t> texels) {
  constexpr std::array<std::array<int, 2>, 8> neighbours{
      {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {1, -1}, {-1, 1}}};
  std::vector<std::pair<std::size_t, std::int32_t>> filled;
  for (int ring = 0; ring < rings; ++ring) {
    filled.clear();
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * picture.width + x;
        if (texels[at] != empty) continue;
        for (const auto& [dx, dy] : neighbours) {
          const int nx = x + dx, ny = y + dy;
          if (nx < 0 || ny < 0 || nx >= picture.width || ny >= picture.height) continue;
          const std::int32_t patch = texels[static_cast<std::size_t>(ny) * picture.width + nx];
          if (patch == empty) continue;
          filled.emplace_back(at, patch);
          break;
        }
      }
    }
    for (const auto& [at, patch] : filled) texels[at] = patch;
  }
}

}  // namespace

PlanePicture plane_picture(const Occluders& occluders, std::span<const int> triangles, const Vec3& front,
                           double texels) {
  const Vec3 normal = front.normalized();
  PlanePicture picture;
  Box best{{0, 0}, {0, 0}};
  double smallest = std::numeric_limits<double>::infinity();
  const std::size_t tried = std::min(triangles.size(), most_edges_tried / 3);
  for (std::size_t t = 0; t < tried; ++t) {
    const auto& corners = occluders.triangles[triangles[t * triangles.size() / tried]];
    for (int k = 0; k < 3; ++k) {
      Vec3 x = occluders.vertices[corners[(k + 1) % 3]] - occluders.vertices[corners[k]];
      x -= x.dot(normal) * normal;
      if (!(x.norm() > 0)) continue;
      x.normalize();
      const Vec3 y = normal.cross(x);
      const Box box = box_along(occluders, triangles, x, y);
      if (!(box.area() < smallest)) continue;
      smallest = box.area();
      best = box;
      picture.along_x = x;
      picture.along_y = y;
    }
  }
  const Eigen::Array2d extent = best.high - best.low;
  const double area = front.norm() / 2;
  if (!(smallest > 0) || smallest > most_emptiness * area) return picture;  // one texel
  const double side = std::sqrt(area / texels);
  const auto steps = [&](double length) {
    return static_cast<int>(std::ceil(std::min<double>(length / side, HitMap::largest_size)));
  };
  picture.width = steps(extent[0]);
  picture.height = steps(extent[1]);
  picture.origin = occluders.vertices[occluders.triangles[triangles[0]][0]] + best.low[0] * picture.along_x +
                   best.low[1] * picture.along_y;
  picture.along_x *= picture.width / extent[0];
  picture.along_y *= picture.height / extent[1];
  return picture;
}

void draw_patches(const PatchMesh& mesh, std::span<const int> patches, const PlanePicture& picture,
                  std::span<std::int32_t> texels) {
  constexpr std::int32_t empty = -2;
  std::fill(texels.begin(), texels.end(), HitMap::ask);
  if (picture.width == 1 && picture.height == 1) return;
  std::fill(texels.begin(), texels.end(), empty);
  const Eigen::Array2i last(picture.width - 1, picture.height - 1);
  std::vector<int> lost;
  for (int patch : patches) {
    const Outline outline(mesh, patch, picture);
    const Eigen::Array2i low = outline.low(0).max(0), high = outline.high(0).min(last);
    bool drawn = false;
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        if (!outline.holds(sample_of(x, y))) continue;
        texels[static_cast<std::size_t>(y) * picture.width + x] = patch;
        drawn = true;
      }
    }
    if (!drawn) lost.push_back(patch);
  }
  spread(picture, empty, texels);
  std::replace(texels.begin(), texels.end(), empty, HitMap::ask);
  for (int patch : lost) {
    const Outline outline(mesh, patch, picture);
    const Eigen::Array2i low = outline.low(0).max(0), high = outline.high(0).min(last);
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x)
        texels[static_cast<std::size_t>(y) * picture.width + x] = HitMap::ask;
    }
  }
}

void draw_doubt(const PlanePicture& picture, const Vec3& from, const Vec3& to,
                std::span<std::int32_t> texels) {
  // from the centre of a texel to its farthest points
  constexpr double reach = 0.7072;
  const Eigen::Vector2d a = picture.at(from), edge = picture.at(to) - a;
  const Eigen::Array2d low = a.array().min((a + edge).array()), high = a.array().max((a + edge).array());
  const Eigen::Array2i first = (low - reach).floor().cast<int>().max(0);
  const Eigen::Array2i last =
      (high + reach).floor().cast<int>().min(Eigen::Array2i(picture.width - 1, picture.height - 1));
  for (int y = first[1]; y <= last[1]; ++y) {
    for (int x = first[0]; x <= last[0]; ++x) {
      const Eigen::Vector2d way = Eigen::Vector2d(x + 0.5, y + 0.5) - a;
      const double along = std::clamp(way.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      if ((way - along * edge).norm() > reach) continue;
      texels[static_cast<std::size_t>(y) * picture.width + x] = HitMap::ask;
    }
  }
}

}  // namespace luxel
