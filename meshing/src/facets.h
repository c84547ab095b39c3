#pragma once

#include <span>
#include <string>
#include <vector>

#include "luxel/scene.h"
#include "repeated_loops.h"

namespace luxel {

/// The scene's faces as flat loops over welded vertices. A face that is flat is one facet, however many
/// corners it has; any other is several triangles. Faces without area and repeated faces are gone.
struct Facets {
  std::vector<Vec3> vertices;  ///< [m]
  Loops loops;                 ///< one per facet; indices into `vertices`, counter-clockwise from the front
  std::vector<int> faces;      ///< the scene's face that the facet is (part of), ascending
  std::vector<char> front;     ///< whether the front radiates
  std::vector<char> back;      ///< whether the back does: two-sided
  int welded_vertices = 0;
  int degenerate_faces = 0;
  int duplicate_faces = 0;
  int split_faces = 0;  ///< faces that are no flat convex triangle or quad
  std::vector<std::string> warnings;

  int size() const { return static_cast<int>(faces.size()); }
  std::span<const int> loop(int facet) const { return loops[facet]; }
};

/// @throws InputError if no face has an area.
Facets make_facets(const Scene& scene);

/// Triangles (places in the loop) of a loop of points that may be concave or not flat. Cost: quadratic.
std::vector<std::array<int, 3>> triangulate_loop(std::span<const Vec3> loop);

}  // namespace luxel
