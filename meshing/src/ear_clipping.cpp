#include "ear_clipping.h"

#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Twice the signed area.
double doubled_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return cross(b - a, c - a);
}

/// The sine of the smallest angle, negative for a clockwise triangle: what makes one ear better than another.
double quality(const Vec2& a, const Vec2& b, const Vec2& c) {
  std::array<double, 3> sides = {(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()};
  std::sort(sides.begin(), sides.end());
  return sides[1] > 0 ? doubled_area(a, b, c) / std::sqrt(sides[1] * sides[2]) : 0;
}

class EarClipper {
 public:
  explicit EarClipper(std::span<const Vec2> loop) : loop_(loop), count_(static_cast<int>(loop.size())) {
    for (int i = 0; i < count_; ++i) {
      previous_.push_back((i + count_ - 1) % count_);
      next_.push_back((i + 1) % count_);
      alive_.push_back(true);
    }
    for (int i = 0; i < count_; ++i) rank_.push_back(rank(i));
  }

  std::vector<std::array<int, 3>> clip() {
    std::vector<std::array<int, 3>> triangles;
    for (int left = count_; left >= 3; --left) {
      int best = -1;
      for (int i = 0; i < count_; ++i) {
        if (alive_[i] && (best < 0 || rank_[i] > rank_[best])) best = i;
      }
      const int before = previous_[best];
      const int after = next_[best];
      if (quality(loop_[before], loop_[best], loop_[after]) > thinnest) {
        triangles.push_back({before, best, after});
      }
      alive_[best] = false;
      next_[before] = after;
      previous_[after] = before;
      rank_[before] = rank(before);
      rank_[after] = rank(after);
    }
    return triangles;
  }

 private:
  // Sine of the smallest angle below which a triangle is a line.
  static constexpr double thinnest = 1e-12;

  /// True ears rank above 0 by their shape; what is no ear ranks below, so that a loop that crosses itself is
  /// still used up.
  double rank(int i) const {
    const int before = previous_[i];
    const int after = next_[i];
    const Vec2& a = loop_[before];
    const Vec2& b = loop_[i];
    const Vec2& c = loop_[after];
    const double shape = quality(a, b, c);
    if (shape <= thinnest) return shape - 4;
    for (int j = next_[after]; j != before; j = next_[j]) {
      const Vec2& p = loop_[j];
      if (p == a || p == b || p == c) continue;
      if (doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0) {
        return shape - 2;
      }
    }
    return shape;
  }

  std::span<const Vec2> loop_;
  int count_;
  std::vector<int> previous_, next_;
  std::vector<bool> alive_;
  std::vector<double> rank_;
};

}  // namespace

std::vector<std::array<int, 3>> clip_ears(std::span<const Vec2> loop) {
  if (loop.size() < 3) return {};
  return EarClipper(loop).clip();
}

}  // namespace luxel
