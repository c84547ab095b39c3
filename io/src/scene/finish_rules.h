#pragma once

#include <string>
#include <vector>

#include "luxel/scene.h"
#include "scene/scene_description.h"
#include "scene/surface_soup.h"

namespace luxel {

/// The finishes of a scene's faces.
struct Finishes {
  std::vector<int> of_face;  ///< F indices into `table`
  std::vector<Finish> table;
  std::vector<std::string> warnings;
};

/// The finish of each face from the rules of the scene file and what the mesh states; lengths in metres.
/// Power is spread evenly over the area of the faces that take it, both sides of them where two-sided; of
/// faces that lie on each other with their fronts the same way, only the first counts as area.
/// @throws InputError for a rule whose name the mesh does not have, or that spreads power over no area.
Finishes resolved_finishes(const SurfaceSoup& soup, const SceneDescription& description);

}  // namespace luxel
