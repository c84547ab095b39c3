#pragma once

#include <cstdint>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/tone_map.h"

namespace luxel {

/// Luminance of the radiance B / pi of each row [W/(m2 sr)].
std::vector<double> luminances(const PatchField& radiosity);

/// The tone map for patches as seen by nobody in particular: weighted by their areas.
ToneMap tone_map_for(const PatchMesh& mesh, const std::vector<double>& luminances);

/// 8-bit sRGB of the radiance B / pi of each row, three bytes each.
std::vector<std::uint8_t> display_colours(const PatchField& radiosity, const ToneMap& tone_map);

}  // namespace luxel
