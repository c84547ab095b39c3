#include "stress/scene_builder.h"

#include <algorithm>

namespace luxel::stress {

SceneBuilder& SceneBuilder::finish(double reflectance, double emission, bool two_sided) {
  scene_.finishes.push_back({Rgb::Constant(reflectance), Rgb::Constant(emission), two_sided});
  return *this;
}

int SceneBuilder::index_of(const std::string& name) {
  const auto found = std::find(scene_.groups.begin(), scene_.groups.end(), name);
  if (found == scene_.groups.end()) {
    scene_.groups.push_back(name);
    return static_cast<int>(scene_.groups.size()) - 1;
  }
  return static_cast<int>(found - scene_.groups.begin());
}

SceneBuilder& SceneBuilder::face(const std::string& name, const std::vector<Vec3>& corners) {
  if (scene_.finishes.empty()) finish(0.5, 0);
  if (scene_.materials.empty()) scene_.materials.push_back("default");
  for (const Vec3& corner : corners) {
    // faces share their corners, as in a file
    const auto found = std::find(scene_.vertices.begin(), scene_.vertices.end(), corner);
    scene_.face_vertices.push_back(static_cast<int>(found - scene_.vertices.begin()));
    if (found == scene_.vertices.end()) scene_.vertices.push_back(corner);
  }
  scene_.face_offsets.push_back(static_cast<int>(scene_.face_vertices.size()));
  scene_.face_groups.push_back(index_of(name));
  scene_.face_materials.push_back(0);
  scene_.face_finishes.push_back(static_cast<int>(scene_.finishes.size()) - 1);
  return *this;
}

SceneBuilder& SceneBuilder::grid(const std::string& name, const Vec3& corner, const Vec3& u, const Vec3& v,
                                 int n, int m) {
  const auto at = [&](int i, int j) -> Vec3 { return corner + double(i) / n * u + double(j) / m * v; };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) face(name, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  return *this;
}

SceneBuilder& SceneBuilder::box(const std::string& prefix, const Vec3& low, const Vec3& high, int n,
                                bool inward) {
  const Vec3 size = high - low;
  const Vec3 x = size.x() * Vec3::UnitX(), y = size.y() * Vec3::UnitY(), z = size.z() * Vec3::UnitZ();
  const auto side = [&](const char* name, const Vec3& corner, const Vec3& u, const Vec3& v) {
    inward ? grid(prefix + name, corner, u, v, n, n) : grid(prefix + name, corner, v, u, n, n);
  };
  side("floor", low, x, y);
  side("ceiling", low + z, y, x);
  side("y0", low, z, x);
  side("x1", low + x, z, y);
  side("y1", low + y, x, z);
  side("x0", low, y, z);
  return *this;
}

Scene moved(Scene scene, double scale, const Vec3& offset) {
  for (Vec3& vertex : scene.vertices) vertex = scale * vertex + offset;
  return scene;
}

Scene painted(Scene scene, const std::string& group, double reflectance, double emission) {
  const int index =
      static_cast<int>(std::find(scene.groups.begin(), scene.groups.end(), group) - scene.groups.begin());
  scene.finishes.push_back({Rgb::Constant(reflectance), Rgb::Constant(emission), false});
  for (int f = 0; f < scene.face_count(); ++f) {
    if (scene.face_groups[f] == index) scene.face_finishes[f] = static_cast<int>(scene.finishes.size()) - 1;
  }
  return scene;
}

}  // namespace luxel::stress
