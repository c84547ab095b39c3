#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "luxel/scene.h"

namespace luxel {

/// A scene under construction: faces are added by their corner positions, so that nothing is shared until the
/// mesher welds it.
class SceneMaker {
 public:
  SceneMaker() {
    scene_.groups = {"default"};
    scene_.materials = {"default"};
    scene_.finishes = {Finish{}};
  }

  SceneMaker& face(const std::vector<Vec3>& corners, int finish = 0) {
    for (const Vec3& p : corners) {
      scene_.face_vertices.push_back(static_cast<int>(scene_.vertices.size()));
      scene_.vertices.push_back(p);
    }
    scene_.face_offsets.push_back(static_cast<int>(scene_.face_vertices.size()));
    scene_.face_groups.push_back(0);
    scene_.face_materials.push_back(finish);
    scene_.face_finishes.push_back(finish);
    return *this;
  }

  /// A second, third ... material with this finish; returns its index.
  int add_finish(const Finish& finish) {
    scene_.finishes.push_back(finish);
    scene_.materials.push_back("material " + std::to_string(scene_.materials.size()));
    return static_cast<int>(scene_.finishes.size()) - 1;
  }

  /// The six quads of a box; normals point inwards.
  SceneMaker& room(const Vec3& low, const Vec3& high, int finish = 0) { return box(low, high, finish, true); }

  /// The six quads of a box; normals point outwards.
  SceneMaker& block(const Vec3& low, const Vec3& high, int finish = 0) {
    return box(low, high, finish, false);
  }

  const Scene& scene() const { return scene_; }

 private:
  SceneMaker& box(const Vec3& low, const Vec3& high, int finish, bool inwards) {
    const auto corner = [&](int bits) {
      return Vec3(bits & 1 ? high.x() : low.x(), bits & 2 ? high.y() : low.y(),
                  bits & 4 ? high.z() : low.z());
    };
    constexpr int quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                 {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& q : quads) {
      if (inwards) {
        face({corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3])}, finish);
      } else {
        face({corner(q[3]), corner(q[2]), corner(q[1]), corner(q[0])}, finish);
      }
    }
    return *this;
  }

  Scene scene_;
};

}  // namespace luxel
