#include "transport/hierarchical/patch_groups.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace luxel {

namespace {

using Key = std::tuple<int, bool, int, int>;  // polygon, side, finish, enclosure

// Of each patch the number of its group; groups are numbered by their first patches.
std::vector<int> group_numbers(const PatchMesh& mesh, const Enclosures& enclosures,
                               std::vector<int>& first_patches) {
  std::vector<int> numbers(mesh.size()), first_of_polygon;
  std::map<Key, int> found;
  Key last;
  int last_number = -1;
  for (int p = 0; p < mesh.size(); ++p) {
    const int polygon = mesh.polygons[p];
    if (polygon >= static_cast<int>(first_of_polygon.size())) first_of_polygon.resize(polygon + 1, -1);
    int& reference = first_of_polygon[polygon];
    if (reference < 0) reference = p;
    const bool side = mesh.normals[p].dot(mesh.normals[reference]) > 0;
    const Key key{polygon, side, mesh.finishes[p], enclosures.enclosure[p]};
    if (last_number < 0 || key != last) {
      const auto [at, fresh] = found.try_emplace(key, static_cast<int>(found.size()));
      if (fresh) first_patches.push_back(p);
      last = key;
      last_number = at->second;
    }
    numbers[p] = last_number;
  }
  return numbers;
}

// Plane and axes of the patches: u along the longest edge of the largest one, so that the boxes of grids are
// tight.
FlatGroup flat_group(const PatchMesh& mesh, const WorkingFrame& frame, const int* begin, const int* end) {
  FlatGroup group;
  Vec3 normal = Vec3::Zero();
  group.low = Vec3::Constant(std::numeric_limits<double>::infinity());
  group.high = -group.low;
  double height = 0, total = 0;
  int largest = *begin;
  for (const int* p = begin; p != end; ++p) {
    normal += mesh.areas[*p] * mesh.normals[*p];
    if (mesh.areas[*p] > mesh.areas[largest] * (1 + 1e-9)) largest = *p;
  }
  group.normal = normal.normalized();
  for (const int* p = begin; p != end; ++p) {
    height += mesh.areas[*p] * group.normal.dot(frame(mesh.centroids[*p]));
    total += mesh.areas[*p];
    for (int k = 0; k < mesh.corner_count(*p); ++k) {
      const Vec3 x = frame(mesh.vertices[mesh.corners[*p][k]]);
      group.low = group.low.cwiseMin(x);
      group.high = group.high.cwiseMax(x);
    }
  }
  group.offset = height / total;
  group.area = total * frame.scale * frame.scale;
  Vec3 longest = Vec3::Zero();
  for (int k = 0; k < mesh.corner_count(largest); ++k) {
    const int next = k + 1 < mesh.corner_count(largest) ? k + 1 : 0;
    const Vec3 edge = mesh.vertices[mesh.corners[largest][next]] - mesh.vertices[mesh.corners[largest][k]];
    if (edge.squaredNorm() > longest.squaredNorm() * (1 + 1e-9)) longest = edge;
  }
  group.u = (longest - longest.dot(group.normal) * group.normal).normalized();
  group.v = group.normal.cross(group.u);
  return group;
}

}  // namespace

void gather_flat_groups(PatchHierarchy& hierarchy, const Enclosures& enclosures) {
  const PatchMesh& mesh = *hierarchy.mesh;
  std::vector<int> first_patches;
  const std::vector<int> numbers = group_numbers(mesh, enclosures, first_patches);
  std::vector<int> ends(first_patches.size() + 1, 0);
  for (int number : numbers) ++ends[number + 1];
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  const std::vector<int> begins(ends.begin(), ends.end() - 1);
  hierarchy.order.resize(mesh.size());
  hierarchy.group.resize(mesh.size());
  std::vector<int> next = begins;
  for (int p = 0; p < mesh.size(); ++p) {
    hierarchy.group[next[numbers[p]]] = numbers[p];
    hierarchy.order[next[numbers[p]]++] = p;
  }
  hierarchy.groups.resize(first_patches.size());
  tbb::parallel_for(std::size_t{0}, first_patches.size(), [&](std::size_t g) {
    FlatGroup& group = hierarchy.groups[g];
    group = flat_group(mesh, hierarchy.frame, hierarchy.order.data() + begins[g],
                       hierarchy.order.data() + ends[g + 1]);
    group.finish = mesh.finishes[first_patches[g]];
    group.enclosure = enclosures.enclosure[first_patches[g]];
    group.closed = enclosures.enclosure_closed[group.enclosure] != 0;
  });
}

}  // namespace luxel
