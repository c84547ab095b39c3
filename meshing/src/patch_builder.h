#pragma once

#include <span>

#include "luxel/patch_mesh.h"
#include "luxel/scene.h"

namespace luxel {

/// A mesh without patches that has the scene's names, finishes, camera and warnings.
PatchMesh empty_mesh(const Scene& scene);

/// Appends a triangle or quad with corners in mesh.vertices and what it inherits from its face, without
/// normal, centroid and area. `polygon` is the flat polygon of the occluders that it lies in.
void append_patch(PatchMesh& mesh, const Scene& scene, std::span<const int> corners, int face, int polygon);

/// Normals, centroids and areas of all patches, from their corners.
void measure_patches(PatchMesh& mesh);

/// Makes room for `count` patches in every array.
void reserve_patches(PatchMesh& mesh, std::size_t count);

}  // namespace luxel
