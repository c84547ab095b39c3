#include <Eigen/Geometry>
#include <stdexcept>

#include "luxel/plan.h"

namespace luxel {

namespace {

// The box around the patches is widened by this share of its diagonal: far above rounding; whatever touches
// the box too much costs a little time and changes nothing.
constexpr double margin = 1e-6;

Eigen::AlignedBox3d box_around(const PatchMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (int i = 0; i < mesh.size(); ++i) {
    for (int k = 0; k < mesh.corner_count(i); ++k) box.extend(mesh.vertices[mesh.corners[i][k]]);
  }
  if (box.isEmpty()) return box;
  const Vec3 wider = Vec3::Constant(margin * box.diagonal().norm());
  return {box.min() - wider, box.max() + wider};
}

/// Numbers those of `count` things that are used, in the order of their use.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : place_(count, -1) {}

  int operator()(int thing) {
    int& place = place_[thing];
    if (place < 0) {
      place = static_cast<int>(used_.size());
      used_.push_back(thing);
    }
    return place;
  }
  bool known(int thing) const { return place_[thing] >= 0; }
  const std::vector<int>& used() const { return used_; }

 private:
  std::vector<int> place_;
  std::vector<int> used_;
};

template <class Value>
std::vector<Value> chosen(const std::vector<Value>& values, const std::vector<int>& indices) {
  std::vector<Value> result;
  result.reserve(indices.size());
  for (const int i : indices) result.push_back(values[i]);
  return result;
}

}  // namespace

PatchMesh sub_mesh(const PatchMesh& mesh, const std::vector<int>& patches, bool closed) {
  for (const int i : patches) {
    if (i < 0 || i >= mesh.size()) throw std::invalid_argument("sub_mesh: a patch is out of range");
  }
  PatchMesh part;
  part.file = mesh.file;
  part.corners = chosen(mesh.corners, patches);
  part.normals = chosen(mesh.normals, patches);
  part.centroids = chosen(mesh.centroids, patches);
  part.areas = chosen(mesh.areas, patches);
  part.faces = chosen(mesh.faces, patches);
  part.groups = chosen(mesh.groups, patches);
  part.materials = chosen(mesh.materials, patches);
  part.finishes = chosen(mesh.finishes, patches);
  part.group_names = mesh.group_names;
  part.material_names = mesh.material_names;
  part.finish_table = mesh.finish_table;
  part.camera = mesh.camera;

  Renumbering corner(mesh.vertices.size());
  for (auto& corners : part.corners) {
    for (int& index : corners) {
      if (index >= 0) index = corner(index);
    }
  }
  part.vertices = chosen(mesh.vertices, corner.used());

  const Occluders& all = mesh.occluders;
  Renumbering polygon(all.polygon_count);
  for (const int i : patches) part.polygons.push_back(polygon(mesh.polygons[i]));
  const Eigen::AlignedBox3d box = box_around(part);
  Renumbering vertex(all.vertices.size());
  for (std::size_t t = 0; t < all.triangles.size(); ++t) {
    if (closed && !polygon.known(all.polygons[t])) continue;
    Eigen::AlignedBox3d extent;
    for (const int k : all.triangles[t]) extent.extend(all.vertices[k]);
    if (!box.intersects(extent)) continue;
    std::array<int, 3> triangle = all.triangles[t];
    for (int& k : triangle) k = vertex(k);
    part.occluders.triangles.push_back(triangle);
    part.occluders.polygons.push_back(polygon(all.polygons[t]));
  }
  part.occluders.vertices = chosen(all.vertices, vertex.used());
  part.occluders.polygon_count = static_cast<int>(polygon.used().size());
  return part;
}

}  // namespace luxel
