#pragma once

#include <array>
#include <span>
#include <vector>

#include "polygon.h"

namespace luxel {

/// Triangles (indices into the loop, counter-clockwise) of a simple loop that runs counter-clockwise; corners
/// may be concave or straight, and a corner may stand twice, as bridges to holes do. The ear with the largest
/// smallest angle goes first. Triangles without area are left out. Cost: quadratic.
/// Source: G. H. Meisters, Polygons have ears, 1975.
std::vector<std::array<int, 3>> clip_ears(std::span<const Vec2> loop);

}  // namespace luxel
