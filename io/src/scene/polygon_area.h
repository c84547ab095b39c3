#pragma once

#include <vector>

#include "scene/surface_soup.h"

namespace luxel {

/// Area of a face [square of the length unit]: half the length of its vector area, exact for flat polygons,
/// convex or not.
double face_area(const SurfaceSoup& soup, std::size_t face);

/// Of each of the given faces whether one before it has the same corners in the same order (whichever comes
/// first, and whether or not they share vertices).
std::vector<bool> are_repeated(const SurfaceSoup& soup, const std::vector<std::size_t>& faces);

}  // namespace luxel
