#include "face_locator.h"

#include <algorithm>
#include <limits>

#include "weld.h"

namespace luxel {

namespace {

// Boxes looked through reach this far, as a share of the scene: above what a facet may be off its polygon's
// plane.
constexpr double reach = 1e-6;

std::vector<Box> boxes_of(const Facets& facets, std::span<const int> members) {
  std::vector<Box> boxes;
  boxes.reserve(members.size());
  for (const int facet : members) {
    Box box;
    for (const int v : facets.loop(facet)) box.extend(facets.vertices[v]);
    boxes.push_back(box);
  }
  return boxes;
}

/// Squared distance of p from the loop; 0 inside.
double squared_distance(const std::vector<Vec2>& loop, const Vec2& p) {
  bool inside = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = loop[k];
    const Vec2& b = loop[(k + 1) % loop.size()];
    const Vec2 d = b - a;
    const Vec2 x = p - a;
    if ((a.y() > p.y()) != (b.y() > p.y()) && (d.x() * x.y() - d.y() * x.x() > 0) == (b.y() > a.y())) {
      inside = !inside;
    }
    const double along = std::clamp(x.dot(d) / d.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (x - along * d).squaredNorm());
  }
  return inside ? 0 : nearest;
}

}  // namespace

FaceLocator::FaceLocator(const Facets& facets, std::span<const int> members, const Frame& frame)
    : facets_(facets),
      members_(members),
      frame_(frame),
      reach_(members.size() > 1 ? reach * diagonal(facets.vertices) : 0),
      tree_(members.size() > 1 ? boxes_of(facets, members) : std::vector<Box>()) {}

int FaceLocator::face_at(const Vec3& point) const {
  int best = members_[0];
  if (members_.size() == 1) return facets_.faces[best];
  double nearest = std::numeric_limits<double>::infinity();
  const Vec2 p = frame_.flat(point);
  std::vector<Vec2> loop;
  tree_.query(Box(point.array() - reach_, point.array() + reach_), [&](int k) {
    const int facet = members_[k];
    loop.clear();
    for (const int v : facets_.loop(facet)) loop.push_back(frame_.flat(facets_.vertices[v]));
    const double distance = squared_distance(loop, p);
    if (distance < nearest || (distance == nearest && facet < best)) {
      nearest = distance;
      best = facet;
    }
  });
  return facets_.faces[best];
}

}  // namespace luxel
