#include <algorithm>
#include <numeric>

#include "smooth_fans.h"
#include "vertex_corners.h"

namespace luxel {

namespace {

// A patch rises in front of another one if its centroid is higher above that one's plane than this share of
// its distance: above rounding, below any dihedral angle that matters (0.06 degrees).
constexpr double rise = 1e-3;

/// One side of an edge that leaves a vertex: the corner it belongs to and whether the patch runs along it
/// outwards, away from the vertex.
struct EdgeUse {
  int other;  // the vertex at the far end
  bool outwards;
  int corner;  // place among the vertex's corners
};

/// Groups the corners around one vertex into smooth fans.
class FanFinder {
 public:
  FanFinder(const PatchMesh& mesh, double crease_angle) : mesh_(mesh), is_smooth_(mesh, crease_angle) {}

  /// For each corner the place of the first corner of its fan.
  const std::vector<int>& find(int vertex, std::span<const Corner> corners) {
    parent_.resize(corners.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    uses_.clear();
    for (int c = 0; c < static_cast<int>(corners.size()); ++c) {
      const auto [before, after] = neighbours(mesh_.corners[corners[c].patch], corners[c].place);
      uses_.push_back({after, true, c});
      uses_.push_back({before, false, c});
    }
    std::sort(uses_.begin(), uses_.end(), [](const EdgeUse& a, const EdgeUse& b) {
      return a.other != b.other ? a.other < b.other : a.corner < b.corner;
    });
    for (std::size_t begin = 0, end = 0; begin < uses_.size(); begin = end) {
      while (end < uses_.size() && uses_[end].other == uses_[begin].other) ++end;
      join_across(mesh_.vertices[vertex], corners, std::span(uses_).subspan(begin, end - begin));
    }
    for (int c = 0; c < static_cast<int>(corners.size()); ++c) parent_[c] = root(c);
    return parent_;
  }

 private:
  void join_across(const Vec3& vertex, std::span<const Corner> corners, std::span<const EdgeUse> uses) {
    for (const EdgeUse& a : uses) {
      if (!a.outwards) continue;
      const EdgeUse* partner = only_partner(corners, uses, a);
      if (partner == nullptr || only_partner(corners, uses, *partner) != &a) continue;
      const int i = corners[a.corner].patch;
      const int j = corners[partner->corner].patch;
      const bool parted = std::any_of(uses.begin(), uses.end(), [&](const EdgeUse& use) {
        const int k = corners[use.corner].patch;
        return k != i && k != j && rises_from(vertex, i, k) && rises_from(vertex, j, k);
      });
      if (!parted) join(a.corner, partner->corner);
    }
  }

  const EdgeUse* only_partner(std::span<const Corner> corners, std::span<const EdgeUse> uses,
                              const EdgeUse& a) const {
    const EdgeUse* partner = nullptr;
    for (const EdgeUse& b : uses) {
      if (b.outwards == a.outwards || !is_smooth_(corners[a.corner].patch, corners[b.corner].patch)) continue;
      if (partner != nullptr) return nullptr;
      partner = &b;
    }
    return partner;
  }

  bool rises_from(const Vec3& vertex, int patch, int other) const {
    const Vec3 d = mesh_.centroids[other] - vertex;
    return d.dot(mesh_.normals[patch]) > rise * d.norm();
  }

  int root(int c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }

  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  const PatchMesh& mesh_;
  SmoothTransition is_smooth_;
  std::vector<int> parent_;
  std::vector<EdgeUse> uses_;
};

}  // namespace

SmoothFans find_fans_by_index(const PatchMesh& mesh, std::span<const int> patches, double crease_angle) {
  SmoothFans fans;
  for (const int patch : patches) fans.corners.push_back(mesh.corners[patch]);
  const VertexCorners corners_of(fans.corners, static_cast<int>(mesh.vertices.size()));
  FanFinder finder(mesh, crease_angle);
  std::vector<Corner> corners;
  std::vector<int> number_of_fan;
  for (int v = 0; v < corners_of.vertex_count(); ++v) {
    corners.clear();
    for (const auto [i, place] : corners_of[v]) corners.push_back({patches[i], place});
    const std::vector<int>& fan = finder.find(v, corners);
    number_of_fan.assign(corners.size(), -1);
    for (std::size_t c = 0; c < corners.size(); ++c) {
      int& number = number_of_fan[fan[c]];
      if (number < 0) {
        number = static_cast<int>(fans.vertices.size());
        fans.vertices.push_back(v);
        fans.normals.push_back(Vec3::Zero());
      }
      const auto [patch, place] = corners[c];
      const auto [before, after] = neighbours(mesh.corners[patch], place);
      const double angle =
          angle_between(mesh.vertices[before] - mesh.vertices[v], mesh.vertices[after] - mesh.vertices[v]);
      fans.normals[number] += angle * mesh.normals[patch];
      fans.corners[corners_of[v][c].patch][place] = number;
    }
  }
  for (Vec3& normal : fans.normals) normal.normalize();
  return fans;
}

}  // namespace luxel
