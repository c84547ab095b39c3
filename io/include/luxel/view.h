#pragma once

#include "luxel/gouraud.h"
#include "luxel/image.h"
#include "luxel/patch_mesh.h"
#include "luxel/progress.h"

namespace luxel {

/// What a view does with patches that turn their back to the eye.
enum class Backs {
  culled,  ///< not there: from outside one sees into a closed room
  black    ///< as in the scene: dark, and they hide what is behind them
};

struct ViewOptions {
  int samples = 16;  ///< rays a pixel, quasi-random under a tent of two pixels' width, in [1, 4096]
  Backs backs = Backs::culled;
};

/// A perspective view of the solved patches: radiance B / pi, interpolated linearly between the Gouraud
/// vertices (a quad as the two triangles 0 1 2 and 0 2 3). The same bits for any number of threads. Cost:
/// about 0.12 CPU us a ray, 1 s for 800 x 600 pixels with 16 samples.
/// @param vertex_radiosity  V x 3 [W/m2], from interpolate_to_vertices
/// @throws std::invalid_argument for a camera without direction, an `up` along it, a field of view outside
/// (0, 180), less than one pixel or more than 2^28, samples out of range, or fields of the wrong shape;
/// Cancelled
Image render_view(const PatchMesh& mesh, const GouraudMesh& gouraud, const PatchField& vertex_radiosity,
                  const Camera& camera, const ViewOptions& options = {}, const Progress& progress = {});

/// The mesh's own camera, or one that shows all of it, y upwards: where the patches' fronts look to one side
/// on the whole (terrain, a box without its front), from there; in closed rooms horizontally, through the
/// wall that fills the picture best.
Camera view_camera(const PatchMesh& mesh, int width = 800, int height = 600);

}  // namespace luxel
