#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "luxel/patch_mesh.h"
#include "luxel/solve.h"

namespace luxel {

struct CsvOptions {
  bool full_precision = false;  ///< as many digits as read back to the same bits (at most 17) instead of 9
};

/// Writes one row per patch, in patch order: patch, face, group, material, area [m2], centroid [m], normal
/// and E, H, B [W/m2] of the three channels, under the header
/// `patch,face,group,material,area,cx,cy,cz,nx,ny,nz,E_r,E_g,E_b,H_r,H_g,H_b,B_r,B_g,B_b`. Lines end in LF;
/// names are quoted as RFC 4180. E is emission(mesh). Whole or not at all (OutputFile).
/// Cost: about 1 CPU second and 145 MB of file for a million patches; 20 MB of memory.
/// @throws InputError where the file cannot be written
/// @throws std::invalid_argument unless radiosity and irradiance are N x 3
void write_csv(const std::filesystem::path& path, const PatchMesh& mesh, const RadiositySolution& solution,
               const CsvOptions& options = {});

/// A field of a CSV file: in quotes where it has a comma, a quote, a line break or a space at an end, quotes
/// inside doubled. Source: RFC 4180, section 2.
std::string csv_field(std::string_view text);

}  // namespace luxel
