#include "convex_clip.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool is_wide(const ConvexPiece& piece, double tolerance) {
  if (piece.size() < 3) return false;
  double longest = 0;
  for (std::size_t k = 0; k < piece.size(); ++k) {
    longest = std::max(longest, (piece[(k + 1) % piece.size()].flat - piece[k].flat).norm());
  }
  return 2 * flat_area(piece) > tolerance * longest;
}

ClipCorner between(const ClipCorner& a, const ClipCorner& b, double t) {
  return {a.flat + t * (b.flat - a.flat), a.point + t * (b.point - a.point), -1};
}

}  // namespace

double flat_area(const ConvexPiece& piece) {
  double twice = 0;
  for (std::size_t k = 1; k + 1 < piece.size(); ++k) {
    twice += cross(piece[k].flat - piece[0].flat, piece[k + 1].flat - piece[0].flat);
  }
  return twice / 2;
}

Subtraction subtract(const ConvexPiece& piece, std::span<const Vec2> cutter, double tolerance) {
  Subtraction result;
  ConvexPiece rest = piece;
  std::vector<double> heights;
  const auto none = [&] {
    result.outside = {piece};
    result.inside.clear();
    return result;
  };
  for (std::size_t e = 0; e < cutter.size(); ++e) {
    const Vec2& start = cutter[e];
    const Vec2 along = cutter[(e + 1) % cutter.size()] - start;
    const double length = along.norm();
    if (length == 0) continue;
    heights.clear();
    double lowest = 0, highest = 0;
    for (const ClipCorner& corner : rest) {
      const double height = cross(along, corner.flat - start) / length;
      heights.push_back(std::abs(height) <= tolerance ? 0 : height);
      lowest = std::min(lowest, heights.back());
      highest = std::max(highest, heights.back());
    }
    if (highest == 0) return none();
    if (lowest == 0) continue;
    ConvexPiece in, out;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      const std::size_t next = (k + 1) % rest.size();
      if (heights[k] >= 0) in.push_back(rest[k]);
      if (heights[k] <= 0) out.push_back(rest[k]);
      if ((heights[k] > 0 && heights[next] < 0) || (heights[k] < 0 && heights[next] > 0)) {
        const ClipCorner corner = between(rest[k], rest[next], heights[k] / (heights[k] - heights[next]));
        in.push_back(corner);
        out.push_back(corner);
      }
    }
    if (is_wide(out, tolerance)) result.outside.push_back(std::move(out));
    rest = std::move(in);
    if (!is_wide(rest, tolerance)) return none();
  }
  result.inside = std::move(rest);
  return result;
}

}  // namespace luxel
