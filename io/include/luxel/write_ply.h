#pragma once

#include <filesystem>

#include "luxel/gouraud.h"
#include "luxel/patch_mesh.h"

namespace luxel {

/// Writes the Gouraud mesh with its radiosity baked into the vertices, as binary little-endian PLY: x, y, z
/// [m, float64], nx, ny, nz, radiosity_r, radiosity_g, radiosity_b [W/m2] (float32) and the tone-mapped red,
/// green, blue (uchar, sRGB) that viewers and modellers show; a face per patch with its material and group
/// index. Whole or not at all (OutputFile).
/// @param vertex_radiosity  V x 3, from interpolate_to_vertices
/// @throws InputError where the file cannot be written
/// @throws std::invalid_argument for another shape
void write_ply(const std::filesystem::path& path, const PatchMesh& mesh, const GouraudMesh& gouraud,
               const PatchField& vertex_radiosity);

}  // namespace luxel
