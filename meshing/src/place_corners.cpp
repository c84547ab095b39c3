#include "place_corners.h"

#include "box_tree.h"

namespace luxel {

void place_corners(const std::vector<ClipCorner*>& corners, const std::vector<int>& known, double distance,
                   std::vector<Vec3>& vertices) {
  std::vector<Box> boxes;
  boxes.reserve(known.size() + corners.size());
  for (const int v : known) boxes.emplace_back(vertices[v]);
  for (const ClipCorner* corner : corners) boxes.emplace_back(corner->point);
  const BoxTree tree(std::move(boxes));
  const int old = static_cast<int>(known.size());
  for (int k = 0; k < static_cast<int>(corners.size()); ++k) {
    ClipCorner& corner = *corners[k];
    double nearest = distance;
    const Box box(corner.point.array() - distance, corner.point.array() + distance);
    tree.query(box, [&](int other) {
      const int vertex = other < old ? known[other] : other < old + k ? corners[other - old]->vertex : -1;
      if (vertex < 0) return;
      const double away = (vertices[vertex] - corner.point).norm();
      if (away < nearest || (away == nearest && vertex < corner.vertex)) {
        nearest = away;
        corner.vertex = vertex;
      }
    });
    if (corner.vertex >= 0) continue;
    corner.vertex = static_cast<int>(vertices.size());
    vertices.push_back(corner.point);
  }
}

}  // namespace luxel
