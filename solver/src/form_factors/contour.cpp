#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "form_factors/gauss.h"
#include "form_factors/near_kernels.h"
#include "form_factors/pair.h"

namespace luxel {

namespace {

// Where the integrand along an outer edge is not smooth: at the abscissa `at`, `off` the real axis [lengths].
struct Singularity {
  double at, off;
};

class OuterEdge {
 public:
  OuterEdge(const Vec3& start, const Vec3& end, const Polygon& inner)
      : start_(start), length_((end - start).norm()), tangent_((end - start) / length_) {
    for (int k = 0; k < inner.count; ++k) {
      const Vec3 corner = inner[k] - start;
      add(corner);
      const Vec3 edge = inner.next(k) - inner[k];
      const double edge_length = edge.norm();
      if (edge_length > 0) add_line(corner, edge / edge_length, edge_length);
    }
  }

  double length() const { return length_; }
  const Vec3& tangent() const { return tangent_; }
  Vec3 at(double s) const { return start_ + s * tangent_; }

  // Logarithm of the smallest Bernstein ellipse's parameter around [a, b] that holds a singularity.
  double log_ellipse(double a, double b) const {
    const double half = 0.5 * (b - a), middle = 0.5 * (a + b);
    double smallest = 1e9;
    for (int k = 0; k < count_; ++k) {
      const double x = (singularities_[k].at - middle) / half, y = singularities_[k].off / half;
      // sum of the distances from the foci = rho + 1 / rho
      smallest =
          std::min(smallest, std::sqrt((x - 1) * (x - 1) + y * y) + std::sqrt((x + 1) * (x + 1) + y * y));
    }
    const double c = std::max(0.5 * smallest, 1.0);
    return std::log(c + std::sqrt(c * c - 1));
  }

 private:
  // The inner contour's corner at `corner` from the start: ln r is singular at complex s with r = 0.
  void add(const Vec3& corner) {
    const double at = tangent_.dot(corner);
    push(at, (corner - at * tangent_).norm());
  }

  // The inner edge itself: the distance from its line has a branch point where the outer edge passes it.
  void add_line(const Vec3& corner, const Vec3& direction, double edge_length) {
    const Vec3 normal = tangent_.cross(direction);
    const double sine2 = normal.squaredNorm();
    if (sine2 < 1e-20) return;  // parallel: the distance is constant
    const double at = corner.cross(direction).dot(normal) / sine2;
    const double along = corner.cross(tangent_).dot(normal) / sine2;
    const double off = std::abs(corner.dot(normal)) / sine2;
    if (along > -off && along < edge_length + off) push(at, off);
  }

  void push(double at, double off) { singularities_[count_++] = {at, off}; }

  Vec3 start_;
  double length_;
  Vec3 tangent_;
  int count_ = 0;
  std::array<Singularity, 2 * Polygon::capacity> singularities_;
};

// More points than this on one panel cost more than two halves.
constexpr int most_points = 12;

struct Contour {
  const Polygon& inner;
  double log_tolerance;  // of a panel, relative to the square of the edges' lengths
  double shortest;       // panels at a singularity are not halved further [length]
  PointBatch batch;
  double sum = 0;

  void flush() {
    if (batch.count > 0) sum += log_contour(batch, inner);
    batch.count = 0;
  }

  void panel(const OuterEdge& edge, double a, double b) {
    const double rate = edge.log_ellipse(a, b);
    const double needed = -log_tolerance / (2 * rate);
    if (needed > most_points && b - a > shortest) {
      const double middle = 0.5 * (a + b);
      panel(edge, a, middle);
      panel(edge, middle, b);
      return;
    }
    const int points = std::clamp(static_cast<int>(std::ceil(needed)), 2, most_points);
    const GaussRule rule = gauss_rule(points);
    if (batch.count + points > PointBatch::capacity) flush();
    for (int k = 0; k < points; ++k) {
      const Vec3 x = edge.at(a + (b - a) * rule.nodes[k]);
      const Vec3 w = (b - a) * rule.weights[k] * edge.tangent();
      const int slot = batch.count++;
      batch.x[slot] = x[0], batch.y[slot] = x[1], batch.z[slot] = x[2];
      batch.wx[slot] = w[0], batch.wy[slot] = w[1], batch.wz[slot] = w[2];
    }
  }
};

double perimeter(const Polygon& polygon) {
  double sum = 0;
  for (int k = 0; k < polygon.count; ++k) sum += (polygon.next(k) - polygon[k]).norm();
  return sum;
}

}  // namespace

double contour_exchange(const Polygon& a, const Polygon& b, double tolerance) {
  // Each panel's error is a share of (outer length) x (inner length); at a singularity the integrand is
  // s ln s, of which Gauss leaves about 1e-3 of the panel's length squared.
  const double scale = perimeter(a) * perimeter(b);
  if (!(scale > 0)) return 0;
  const double relative = std::clamp(tolerance / scale, 1e-16, 1e-2);
  Contour contour{b, std::log(relative), std::sqrt(1e2 * std::max(tolerance, 1e-32)), {}, 0};
  for (int k = 0; k < a.count; ++k) {
    if (a.next(k) == a[k]) continue;
    const OuterEdge edge(a[k], a.next(k), b);
    contour.panel(edge, 0, edge.length());
  }
  contour.flush();
  return contour.sum / (2 * std::numbers::pi);
}

}  // namespace luxel
