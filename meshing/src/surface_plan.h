#pragma once

#include "facets.h"
#include "luxel/scene.h"
#include "merged_polygons.h"
#include "shared_edges.h"
#include "sizing.h"

namespace luxel {

/// What of a scene is to be cut how: flat polygons are filled with a lattice, the small triangles of curved
/// surfaces are halved. Both share the points on their common edges.
struct SurfacePlan {
  MergedPolygons merged;
  std::vector<int> filled;                               ///< polygons to fill, by their first face
  std::vector<std::vector<std::array<int, 2>>> creases;  ///< for each polygon the contact edges inside it
  std::vector<std::array<int, 3>> halved;                ///< triangles to halve
  std::vector<int> polygon_of_halved;
  SharedEdges edges;                        ///< of the filled polygons and their creases
  std::vector<std::array<int, 2>> watched;  ///< edges that filled and halved parts share
  Turns turns;                              ///< of the filled polygons and of `edges`
  int contact_edges = 0;
};

/// `edges` are those of the facets; `edge_length` is about the one that will be asked for [m]: triangles of a
/// curved surface that are much longer are filled, which makes better angles than halving.
SurfacePlan plan_surface(const Scene& scene, const Facets& facets, const EdgeTable& edges, double edge_length,
                         double crease_angle);

}  // namespace luxel
