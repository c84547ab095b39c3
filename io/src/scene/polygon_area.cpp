#include "scene/polygon_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <set>

namespace luxel {

double face_area(const SurfaceSoup& soup, std::size_t face) {
  const int begin = soup.face_offsets[face];
  const int end = soup.face_offsets[face + 1];
  const Vec3& origin = soup.vertices[soup.face_vertices[begin]];
  Vec3 twice_area = Vec3::Zero();
  for (int c = begin + 1; c + 1 < end; ++c) {
    twice_area += (soup.vertices[soup.face_vertices[c]] - origin)
                      .cross(soup.vertices[soup.face_vertices[c + 1]] - origin);
  }
  return 0.5 * twice_area.norm();
}

std::vector<bool> are_repeated(const SurfaceSoup& soup, const std::vector<std::size_t>& faces) {
  std::set<std::vector<std::array<double, 3>>> seen;
  std::vector<bool> repeated;
  repeated.reserve(faces.size());
  for (const std::size_t face : faces) {
    std::vector<std::array<double, 3>> corners;
    for (int c = soup.face_offsets[face]; c < soup.face_offsets[face + 1]; ++c) {
      const Vec3& vertex = soup.vertices[soup.face_vertices[c]];
      corners.push_back({vertex.x(), vertex.y(), vertex.z()});
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    repeated.push_back(!seen.insert(std::move(corners)).second);
  }
  return repeated;
}

}  // namespace luxel
