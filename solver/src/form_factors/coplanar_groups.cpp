#include "form_factors/coplanar_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace luxel {

namespace {

// Planes are looked up by one number, normal . direction + 0.61 offset: planes near each other have keys near
// each other. The direction is along no axis and no diagonal, so that the planes of a building are told
// apart.
const Vec3 key_direction(0.7390851, 0.4812118, 0.2718282);

double plane_key(const Plane& plane) {
  return plane.normal.dot(key_direction) + 0.61 * plane.offset;
}

// Width across the longest edge: the lever that fixes the normal.
double width(const WorkPatch& patch) {
  return patch.edge > 0 ? patch.area / patch.edge : 0;
}

bool lies_in(const WorkPatch& patch, const WorkPatch& founder, double tolerance) {
  if (patch.plane.normal.dot(founder.plane.normal) <= 0.5) return false;
  for (int k = 0; k < patch.outline.count; ++k) {
    const double arm = 1 + (patch.outline[k] - founder.centroid).norm() / width(founder);
    if (std::abs(founder.plane.distance(patch.outline[k])) > tolerance * arm) return false;
  }
  return true;
}

Plane fitted_plane(const std::vector<WorkPatch>& patches, const std::vector<int>& members) {
  if (members.size() == 1) return patches[members[0]].plane;
  Vec3 normal = Vec3::Zero(), mean = Vec3::Zero();
  double total = 0;
  for (int p : members) {
    normal += area_vector(patches[p].outline);
    mean += patches[p].area * patches[p].centroid;
    total += patches[p].area;
  }
  normal.normalize();
  return {normal, normal.dot(mean) / total};
}

}  // namespace

std::vector<CoplanarGroup> coplanar_groups(const std::vector<WorkPatch>& patches, double tolerance) {
  std::vector<int> by_area(patches.size());
  std::iota(by_area.begin(), by_area.end(), 0);
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](int a, int b) { return patches[a].area > patches[b].area; });
  std::vector<CoplanarGroup> groups;
  std::vector<int> founders;
  std::multimap<double, int> by_key;
  // Keys of one plane differ by the noise of both normals; above this the patch is too thin to have a plane.
  constexpr double largest_window = 1e-2;
  double founder_noise = 0;
  for (int p : by_area) {
    const WorkPatch& patch = patches[p];
    const double noise = 4 * tolerance * (1 + 1 / std::max(width(patch), 1e-300));
    const double window = std::min(noise + founder_noise, largest_window);
    const double key = plane_key(patch.plane);
    // the nearest key that fits wins, so that the order of founding does not matter
    int home = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (auto it = by_key.lower_bound(key - window); it != by_key.end() && it->first <= key + window; ++it) {
      const double gap = std::abs(it->first - key);
      if (gap < nearest && lies_in(patch, patches[founders[it->second]], tolerance)) {
        home = it->second;
        nearest = gap;
      }
    }
    if (home < 0) {
      home = static_cast<int>(groups.size());
      groups.emplace_back();
      founders.push_back(p);
      by_key.emplace(key, home);
      founder_noise = std::max(founder_noise, std::min(noise, 1e-5));
    }
    groups[home].members.push_back(p);
  }
  for (CoplanarGroup& group : groups) {
    std::sort(group.members.begin(), group.members.end());
    group.plane = fitted_plane(patches, group.members);
  }
  return groups;
}

}  // namespace luxel
