#pragma once

#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// Closed enclosures in which nothing emits, so that B = H = 0 there. Only those that the surfaces prove to
/// be closed; see Proof.
struct DarkEnclosures {
  int count = 0;
  int patches = 0;             ///< in all of them
  std::vector<int> enclosure;  ///< N: which of them, from 0, numbered by their first patch; -1: none
  std::vector<int> others;     ///< patches in none, rising
  bool others_closed = false;  ///< the others look into cells that are proven to be closed
};

/// Without rays from patches. One that absorbs nothing in some channel is not among them: it is to be refused
/// as singular. Cost: nothing above most_proven_triangles; below, that of find_shells(), and where some shell
/// of patches without emission goes around its cell, that of find_cells(): 0.1 s at most.
/// @param occluders  of the mesh
DarkEnclosures dark_enclosures(const PatchMesh& mesh, const RayScene& occluders);

}  // namespace luxel
