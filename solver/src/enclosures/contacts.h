#pragma once

#include <vector>

#include "enclosures/triangle_soup.h"

namespace luxel {

/// One flag a triangle: whether it touches or crosses another anywhere but in the corners and edges that the
/// two share by index (a T-vertex, a body that stands on an uncut floor, surfaces that run through each
/// other). Cost: pairs whose boxes overlap; about 0.1 s for 30 000 triangles.
std::vector<char> contacts(const TriangleSoup& soup);

}  // namespace luxel
