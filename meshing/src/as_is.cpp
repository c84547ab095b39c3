#include "as_is.h"

#include <algorithm>

#include "corner_positions.h"
#include "patch_builder.h"
#include "polygon.h"

namespace luxel {

namespace {

struct Piece {
  std::vector<int> corners;
  int polygon;
  char front, back;
};

void append_pieces_of(const Facets& facets, CornerPositions& positions, int facet, int polygon,
                      std::vector<Piece>& pieces) {
  const std::span<const int> loop = facets.loop(facet);
  const std::span<const Vec3> points = positions(loop);
  const char front = facets.front[facet], back = facets.back[facet];
  if (loop.size() == 3 || (loop.size() == 4 && is_convex(points))) {
    pieces.push_back({{loop.begin(), loop.end()}, polygon, front, back});
    return;
  }
  for (const auto& t : triangulate_loop(points)) {
    const std::array<Vec3, 3> triangle = {points[t[0]], points[t[1]], points[t[2]]};
    if (has_area(triangle)) pieces.push_back({{loop[t[0]], loop[t[1]], loop[t[2]]}, polygon, front, back});
  }
}

}  // namespace

std::size_t count_patches(const Facets& facets) {
  std::size_t count = 0;
  for (int i = 0; i < facets.size(); ++i) {
    const std::size_t corners = facets.loop(i).size();
    const std::size_t pieces = corners <= 4 ? 1 : corners - 2;
    count += pieces * (facets.front[i] + facets.back[i]);
  }
  return count;
}

void append_facets(PatchMesh& mesh, const Scene& scene, const Facets& facets,
                   const std::vector<int>& polygon_of_facet) {
  mesh.vertices = facets.vertices;
  reserve_patches(mesh, count_patches(facets));
  std::vector<Piece> pieces;
  CornerPositions positions(facets.vertices);
  for (int begin = 0, end = 0; begin < facets.size(); begin = end) {
    const int face = facets.faces[begin];
    pieces.clear();
    for (; end < facets.size() && facets.faces[end] == face; ++end) {
      append_pieces_of(facets, positions, end, polygon_of_facet[end], pieces);
    }
    for (const Piece& piece : pieces) {
      if (piece.front) append_patch(mesh, scene, piece.corners, face, piece.polygon);
    }
    for (Piece& piece : pieces) {
      if (!piece.back) continue;
      std::reverse(piece.corners.begin(), piece.corners.end());
      append_patch(mesh, scene, piece.corners, face, piece.polygon);
    }
  }
}

}  // namespace luxel
