#include "enclosures/shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "enclosures/union_find.h"

namespace luxel {

namespace {

/// One triangle at an edge between the vertices low < high.
struct EdgeUse {
  int low, high;
  int triangle;
  int opposite;  // vertex
  bool forward;  // the triangle runs from low to high
  double angle = 0;
};

std::vector<EdgeUse> edge_uses(const TriangleSoup& soup) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * soup.triangles.size());
  for (int t = 0; t < soup.size(); ++t) {
    const auto& corners = soup.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const int from = corners[k], to = corners[(k + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), t, corners[(k + 2) % 3], from < to});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return uses;
}

/// Joins sides around one edge, which the uses [begin, end) share.
void join_around(const TriangleSoup& soup, EdgeUse* begin, EdgeUse* end, UnionFind& sides) {
  const Vec3 origin = soup.vertices[begin->low];
  const Vec3 axis = (soup.vertices[begin->high] - origin).normalized();
  const Vec3 first = axis.unitOrthogonal(), second = axis.cross(first);
  for (EdgeUse* use = begin; use != end; ++use) {
    const Vec3 away = soup.vertices[use->opposite] - origin;
    use->angle = std::atan2(away.dot(second), away.dot(first));
  }
  std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.triangle < b.triangle;
  });
  // counter-clockwise about the axis, a triangle that runs along it shows its front to larger angles
  for (EdgeUse* use = begin; use != end; ++use) {
    const EdgeUse* next = use + 1 == end ? begin : use + 1;
    sides.join(side_of(use->triangle, use->forward), side_of(next->triangle, !next->forward));
  }
}

}  // namespace

Shells find_shells(const TriangleSoup& soup) {
  Shells result;
  UnionFind sides(2 * soup.size());
  std::vector<EdgeUse> uses = edge_uses(soup);
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    if (end - begin == 1) {
      const EdgeUse& use = uses[begin];
      result.rims.push_back(
          {use.triangle, use.forward ? use.low : use.high, use.forward ? use.high : use.low});
    }
    join_around(soup, uses.data() + begin, uses.data() + end, sides);
  }
  result.shell.resize(2 * soup.size());
  for (int s = 0; s < 2 * soup.size(); ++s) {
    const int root = sides.root(s);
    result.shell[s] = root == s ? result.count++ : result.shell[root];
  }
  return result;
}

}  // namespace luxel
