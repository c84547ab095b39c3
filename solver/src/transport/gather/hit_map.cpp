#include "transport/gather/hit_map.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>

#include "transport/gather/contact_edges.h"
#include "transport/gather/plane_picture.h"

namespace luxel {

namespace {

// Texels a patch: 16 move boundaries by an eighth of a patch at most, which is felt (1e-3 of the irradiance
// in a room of 600 patches) where there are more rays than this for each; at a million patches the picture's
// place in the cache counts more.
constexpr double least_texels = 4, usual_texels = 16, most_texels = 256;
constexpr double rays_a_texel = 16;
constexpr double texels_in_all = 4e6;

/// Indices 0 .. keys.size(), in lists by their keys, each list in order.
struct Lists {
  std::vector<int> starts, items;

  Lists(const std::vector<int>& keys, int key_count) : starts(key_count + 1, 0), items(keys.size()) {
    for (int key : keys) ++starts[key + 1];
    for (int k = 0; k < key_count; ++k) starts[k + 1] += starts[k];
    std::vector<int> next(starts.begin(), starts.end() - 1);
    for (std::size_t i = 0; i < keys.size(); ++i) items[next[keys[i]]++] = static_cast<int>(i);
  }
  std::span<const int> operator[](int key) const {
    return {items.data() + starts[key], items.data() + starts[key + 1]};
  }
};

Vec3 front_of(const Occluders& occluders, std::span<const int> triangles) {
  Vec3 normal = Vec3::Zero();
  for (int t : triangles) {
    const auto& [a, b, c] = occluders.triangles[t];
    const Vec3& x = occluders.vertices[a];
    normal += (occluders.vertices[b] - x).cross(occluders.vertices[c] - x);
  }
  return normal;
}

}  // namespace

double HitMap::texels_for(int patches, int rays) {
  const double wanted = std::clamp(rays / rays_a_texel, usual_texels, most_texels);
  return std::max(least_texels, std::min(wanted, texels_in_all / std::max(1, patches)));
}

// one triangle where there is none: a lane that met nothing reads it
HitMap::HitMap(const PatchMesh& mesh, double texels_a_patch)
    : triangles_(std::max<std::size_t>(1, mesh.occluders.triangles.size())) {
  const Occluders& occluders = mesh.occluders;
  const int polygons = occluders.polygon_count;
  const Lists triangles_of(occluders.polygons, polygons);
  std::vector<int> side_of(mesh.size());
  std::vector<Vec3> fronts(polygons);
  for (int p = 0; p < polygons; ++p) fronts[p] = front_of(occluders, triangles_of[p]);
  for (int i = 0; i < mesh.size(); ++i) {
    side_of[i] = 2 * mesh.polygons[i] + (mesh.normals[i].dot(fronts[mesh.polygons[i]]) > 0 ? 0 : 1);
  }
  const Lists patches_of(side_of, 2 * polygons);
  // of sheets that overlap in a plane a ray may be told of either: a side without patches has a picture too
  // then, of doubt
  std::vector<char> doubtful(polygons, 0);
  for (const auto& [p, q] : occluders.coplanar) doubtful[p] = doubtful[q] = 1;
  const auto has_picture = [&](int p, int side) { return doubtful[p] || !patches_of[2 * p + side].empty(); };

  std::vector<PlanePicture> pictures(polygons);
  std::vector<std::int32_t> first(polygons, 0);
  std::size_t total = 0;
  for (int p = 0; p < polygons; ++p) {
    const auto front = patches_of[2 * p], back = patches_of[2 * p + 1];
    const auto& [fewer, more] = std::minmax(front, back, [](auto a, auto b) { return a.size() < b.size(); });
    if (more.size() > 1) {
      const auto grid = fewer.size() > 1 ? std::nullopt : grid_picture(mesh, triangles_of[p], more);
      pictures[p] = grid ? *grid
                         : plane_picture(occluders, triangles_of[p], fronts[p],
                                         static_cast<double>(more.size()) * texels_a_patch);
    }
    first[p] = static_cast<std::int32_t>(total);
    for (int side = 0; side < 2; ++side) {
      if (has_picture(p, side)) total += pictures[p].texels();
    }
  }
  if (total >= std::numeric_limits<std::int32_t>::max()) {
    throw std::invalid_argument("HitMap: more patches than texel numbers of 31 bits");
  }
  texels_.assign(total + 1, ask);
  texels_.back() = mesh.size();
  const ContactEdges contacts(mesh);
  tbb::parallel_for(0, polygons, [&](int p) {
    const PlanePicture& picture = pictures[p];
    std::size_t drawn = first[p];
    for (int side = 0; side < 2; ++side) {
      const auto patches = patches_of[2 * p + side];
      if (!has_picture(p, side)) continue;
      const std::span<std::int32_t> texels(texels_.data() + drawn, picture.texels());
      drawn += picture.texels();
      if (patches.empty()) continue;
      if (patches.size() == 1) {
        std::fill(texels.begin(), texels.end(), patches[0]);
      } else if (picture.grid) {
        draw_grid(mesh, patches, picture, texels);
      } else {
        draw_patches(mesh, patches, picture, texels);
        for (const auto& [a, b] : contacts.between(patches)) {
          draw_doubt(picture, mesh.vertices[a], mesh.vertices[b], texels);
        }
      }
    }
    const std::uint32_t sides = (has_picture(p, 0) ? front_side : 0) | (has_picture(p, 1) ? back_side : 0);
    for (int t : triangles_of[p]) {
      Triangle& triangle = triangles_[t];
      triangle.size = static_cast<std::uint32_t>(picture.width) |
                      static_cast<std::uint32_t>(picture.height) << size_bits | sides;
      triangle.first = first[p];
      const auto& [a, b, c] = occluders.triangles[t];
      const Eigen::Vector2d x = picture.at(occluders.vertices[a]);
      const Eigen::Vector2d u = picture.at(occluders.vertices[b]) - x;
      const Eigen::Vector2d v = picture.at(occluders.vertices[c]) - x;
      triangle.x0 = static_cast<float>(x[0]);
      triangle.y0 = static_cast<float>(x[1]);
      triangle.xu = static_cast<float>(u[0]);
      triangle.yu = static_cast<float>(u[1]);
      triangle.xv = static_cast<float>(v[0]);
      triangle.yv = static_cast<float>(v[1]);
    }
  });
}

std::int32_t HitMap::at(int triangle, bool front, float u, float v) const {
  const Triangle& t = triangles_[triangle];
  if (!(t.size & (front ? front_side : back_side))) return off_patches;
  const auto width = static_cast<std::int32_t>(t.size & largest_size);
  const auto height = static_cast<std::int32_t>(t.size >> size_bits & largest_size);
  const bool behind = !front && (t.size & front_side);
  const std::int32_t x = std::min(static_cast<std::int32_t>(t.x0 + u * t.xu + v * t.xv), width - 1);
  const std::int32_t y = std::min(static_cast<std::int32_t>(t.y0 + u * t.yu + v * t.yv), height - 1);
  return texels_[t.first + ((behind ? height : 0) + y) * width + x];
}

}  // namespace luxel
