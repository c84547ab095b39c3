#include "enclosures/contacts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>

namespace luxel {

namespace {

using Triangle = std::array<Vec3, 3>;

/// Source: Ericson, Real-Time Collision Detection, 2005, 5.1.5.
double distance(const Vec3& p, const Triangle& t) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.norm();
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.norm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).norm();
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.norm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).norm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return (bp - (d4 - d3) / (d4 - d3 + d5 - d6) * (t[2] - t[1])).norm();
  }
  return std::abs(ab.cross(ac).normalized().dot(ap));
}

/// Distance of the segments pq and rs. Source: Ericson 2005, 5.1.9.
double distance(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  const Vec3 d1 = q - p, d2 = s - r, w = p - r;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(w), c = d1.dot(w), b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double along = denominator > 0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double across = (b * along + f) / e;
  if (across < 0 || across > 1) {
    across = std::clamp(across, 0.0, 1.0);
    along = std::clamp((b * across - c) / a, 0.0, 1.0);
  }
  return (p + along * d1 - r - across * d2).norm();
}

/// Whether the segment pq crosses the triangle.
bool crosses(const Vec3& p, const Vec3& q, const Triangle& t) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double from = normal.dot(p - t[0]), to = normal.dot(q - t[0]);
  if ((from > 0) == (to > 0)) return false;
  const Vec3 x = p + from / (from - to) * (q - p);
  for (int k = 0; k < 3; ++k) {
    const Vec3& a = t[k];
    if (normal.dot((t[(k + 1) % 3] - a).cross(x - a)) < 0) return false;
  }
  return true;
}

/// Whether a and b meet within `reach` outside of what they share. shared_a[k]: corner k of a is one of b's.
bool touch(const Triangle& a, const Triangle& b, const std::array<bool, 3>& shared_a,
           const std::array<bool, 3>& shared_b, double reach) {
  for (int k = 0; k < 3; ++k) {
    if (!shared_a[k] && distance(a[k], b) <= reach) return true;
    if (!shared_b[k] && distance(b[k], a) <= reach) return true;
  }
  for (int i = 0; i < 3; ++i) {
    const int i_next = (i + 1) % 3;
    const bool free_a = !shared_a[i] && !shared_a[i_next];
    if (free_a && crosses(a[i], a[i_next], b)) return true;
    const bool free_b = !shared_b[i] && !shared_b[i_next];
    if (free_b && crosses(b[i], b[i_next], a)) return true;
    for (int j = 0; j < 3; ++j) {
      const int j_next = (j + 1) % 3;
      // two edges at one shared corner meet there and nowhere else
      if (!free_a && (shared_b[j] || shared_b[j_next])) continue;
      if (distance(a[i], a[i_next], b[j], b[j_next]) <= reach) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<char> contacts(const TriangleSoup& soup) {
  const int size = soup.size();
  // sorted along a direction that no axis-parallel wall is at right angles to
  const Vec3 sweep = Vec3(1, 0.7548776662, 0.5698402910).normalized();
  struct Extent {
    double begin, end;
    Eigen::AlignedBox3d box;
    int triangle;
  };
  std::vector<Extent> extents(size);
  for (int t = 0; t < size; ++t) {
    Extent& extent = extents[t];
    extent.triangle = t;
    extent.begin = extent.end = sweep.dot(soup.corner(t, 0));
    for (int k = 0; k < 3; ++k) {
      const double place = sweep.dot(soup.corner(t, k));
      extent.begin = std::min(extent.begin, place);
      extent.end = std::max(extent.end, place);
      extent.box.extend(soup.corner(t, k));
    }
    const Vec3 reach = Vec3::Constant(soup.tolerance);
    extent.box.min() -= reach;
    extent.box.max() += reach;
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.triangle < b.triangle;
  });

  std::vector<char> touched(size, 0);
  const auto mark = [&](int t) { std::atomic_ref(touched[t]).store(1, std::memory_order_relaxed); };
  tbb::parallel_for(tbb::blocked_range<int>(0, size, 64), [&](const tbb::blocked_range<int>& range) {
    for (int i = range.begin(); i < range.end(); ++i) {
      const int s = extents[i].triangle;
      const Triangle a{soup.corner(s, 0), soup.corner(s, 1), soup.corner(s, 2)};
      for (int j = i + 1; j < size && extents[j].begin <= extents[i].end + 2 * soup.tolerance; ++j) {
        if (!extents[i].box.intersects(extents[j].box)) continue;
        const int t = extents[j].triangle;
        std::array<bool, 3> shared_a{}, shared_b{};
        for (int k = 0; k < 3; ++k) {
          for (int l = 0; l < 3; ++l) {
            if (soup.triangles[s][k] == soup.triangles[t][l]) shared_a[k] = shared_b[l] = true;
          }
        }
        const Triangle b{soup.corner(t, 0), soup.corner(t, 1), soup.corner(t, 2)};
        const bool same = shared_a[0] && shared_a[1] && shared_a[2];
        if (same || touch(a, b, shared_a, shared_b, soup.tolerance)) {
          mark(s);
          mark(t);
        }
      }
    }
  });
  return touched;
}

}  // namespace luxel
