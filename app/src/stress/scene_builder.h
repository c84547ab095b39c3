#pragma once

#include <string>
#include <vector>

#include "luxel/scene.h"

namespace luxel::stress {

/// Builds small scenes in code, face by face.
class SceneBuilder {
 public:
  /// Faces added from now on get these values in all channels.
  SceneBuilder& finish(double reflectance, double emission, bool two_sided = false);
  /// One flat polygon, corners counter-clockwise seen from the front; its group is `name`.
  SceneBuilder& face(const std::string& name, const std::vector<Vec3>& corners);
  /// n x m quads on corner + s u + t v; the front is where u x v points.
  SceneBuilder& grid(const std::string& name, const Vec3& corner, const Vec3& u, const Vec3& v, int n, int m);
  /// An axis-parallel box of n x n quads a side, groups floor, ceiling, y0, x1, y1, x0 behind `prefix`; seen
  /// from inside or from outside.
  SceneBuilder& box(const std::string& prefix, const Vec3& low, const Vec3& high, int n, bool inward);

  Scene scene() const { return scene_; }

 private:
  int index_of(const std::string& name);
  Scene scene_;
};

/// The scene with every vertex x replaced by scale * x + offset.
Scene moved(Scene scene, double scale, const Vec3& offset);

/// The scene with other values on the faces of one group.
Scene painted(Scene scene, const std::string& group, double reflectance, double emission);

}  // namespace luxel::stress
