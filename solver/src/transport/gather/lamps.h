#pragma once

#include <array>
#include <vector>

#include "luxel/patch_mesh.h"
#include "luxel/ray_scene.h"

namespace luxel {

/// What emits alike on one side of one flat polygon, in the coordinates of the ray scene.
struct Lamp {
  Vec3 normal;                               ///< unit, the side that shines
  double offset = 0;                         ///< normal . x on its plane
  std::vector<std::array<Vec3, 2>> outline;  ///< directed edges, the lamp on their left seen from its front
  Vec3 corner, along, up;  ///< a parallelogram around the lamp, or (triangle) twice the lamp itself
  bool triangle = false;
  bool fills_frame = false;     ///< every point of the frame is on the lamp
  double filled = 1;            ///< share of the frame that is lamp
  double area = 0;              ///< [m2]
  Eigen::RowVectorXd emission;  ///< m columns [W/m2]

  /// Whether a point of its plane is on it.
  bool holds(const Vec3& point) const;
  /// From a point to the nearest of the frame's.
  double distance(const Vec3& point) const;
};

/// The lamps of a mesh, in order of their first patches' polygons. Cost: n log n in the emitting patches.
std::vector<Lamp> lamps_of(const PatchMesh& mesh, const PatchField& emission, const RayScene& occluders);

/// Form factor from a point with a unit normal to an unoccluded lamp: Lambert's contour integral (1760) over
/// its outline, cut at the horizon of the point. 0 behind the lamp. Source: Cohen and Wallace 1993, 4.4.1.
double form_factor(const Vec3& point, const Vec3& normal, const Lamp& lamp);

}  // namespace luxel
