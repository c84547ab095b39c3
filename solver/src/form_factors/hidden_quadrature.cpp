#include "form_factors/hidden_quadrature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "form_factors/hidden_rules.h"
#include "luxel/form_factors.h"

namespace luxel {

namespace {

// Within a smooth cell the hidden area is a polynomial of degree two in the point as long as the cell's
// radius r is small against its distance D from the nearest edge, with corrections by powers of r / D: a
// one-point rule errs by about this share, one of order n > 1 by this times (2 D / r)^(2 - 2 n). Measured on
// rooms and rotated boxes, see docs/decisions/0007-visibility.md.
constexpr double gauss_constant = 0.1;

// Cells are halved at most so often on their way to an edge that touches them; what is left then is
// 2^-depth of the patch.
constexpr int deepest = 12;

constexpr int highest_order = 4;

// Cells may err by the square root of their share of the tolerance, as if their errors had either sign. Where
// their sum shows that they do not, all is done again with less for each, at most so often.
constexpr int attempts = 3;

// A corner that differs from all points of the rules has about this share of the part's area: a cone over a
// third of two of its sides.
constexpr double corner_share = 0.05;

// What a sum of arcs around a hidden polygon loses to rounding, and a patch to the gap between welded faces.
constexpr double covered_rounding = 1e-9;

double squared_distance(const Vec3& x, const Vec3& p, const Vec3& q) {
  const Vec3 along = q - p, from = x - p;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp(from.dot(along) / length, 0.0, 1.0) : 0.0;
  return (from - t * along).squaredNorm();
}

// Two halves of a cell across its longest extent.
struct HalvedCells {
  Polygon first, second;
};

HalvedCells halve(const Polygon& cell, const Vec3& middle) {
  double longest = 0;
  Vec3 direction = Vec3::UnitX();
  for (int k = 0; k < cell.count; ++k) {
    for (int l = 0; l < k; ++l) {
      const Vec3 between = cell[k] - cell[l];
      if (between.squaredNorm() > longest) {
        longest = between.squaredNorm();
        direction = between;
      }
    }
  }
  // of a quad, across its longer sides rather than its diagonal: the halves stay quads
  if (cell.count == 4) {
    const Vec3 s = (cell[1] - cell[0]) + (cell[2] - cell[3]), t = (cell[3] - cell[0]) + (cell[2] - cell[1]);
    const bool along_s = s.squaredNorm() >= t.squaredNorm();
    const int k = along_s ? 0 : 1;
    const Vec3 m0 = 0.5 * (cell[k] + cell[k + 1]), m1 = 0.5 * (cell[k + 2] + cell[(k + 3) % 4]);
    HalvedCells parts;
    parts.first.count = parts.second.count = 4;
    parts.first.corners = {m1, cell[(k + 3) % 4], cell[k], m0};
    parts.second.corners = {m0, cell[k + 1], cell[k + 2], m1};
    return parts;
  }
  const Vec3 normal = direction.normalized();
  const Plane plane{normal, normal.dot(middle)};
  HalvedCells parts{clip(cell, plane, 0), clip(cell, plane.flipped(), 0)};
  return parts;
}

}  // namespace

HiddenIntegral& HiddenIntegral::operator+=(const HiddenIntegral& other) {
  value += other.value;
  error += other.error;
  points += other.points;
  return *this;
}

HiddenQuadrature::HiddenQuadrature(const Polygon& inner, const Vec3& normal, const Shadows& shadows,
                                   HiddenWorkspace& workspace)
    : inner_(inner), normal_(normal), shadows_(shadows), workspace_(workspace) {}

double HiddenQuadrature::distance_to_edges(const Vec3& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ShadowEdge& edge : shadows_.edges) {
    nearest = std::min(nearest, squared_distance(point, edge.p, edge.q));
  }
  for (int k = 0; k < inner_.count; ++k) {
    nearest = std::min(nearest, squared_distance(point, inner_[k], inner_.next(k)));
  }
  return std::sqrt(nearest);
}

void HiddenQuadrature::place(const Polygon& cell, double unhidden, double whole, double tolerance,
                             int depth) {
  const Vec3 middle = centroid(cell);
  const double size = area_vector(cell).norm();
  if (!(size > 0)) return;
  double radius = 0;
  for (int k = 0; k < cell.count; ++k) radius = std::max(radius, (cell[k] - middle).squaredNorm());
  radius = std::sqrt(radius);
  const double share = size / whole;
  // a cell holds at most its own area, and hardly more than a few times its share
  const double bound = gauss_constant * std::min(size, 4 * unhidden * share);
  const double allowed = tolerance * std::sqrt(share);
  const double ratio = 2 * distance_to_edges(middle) / radius;
  const double falloff = 1 / (ratio * ratio);
  double error = 2 * bound;
  int order = 0;
  while (order < highest_order && error > allowed) {
    ++order;
    error = order == 1 ? bound : error * falloff;
  }
  if (error > allowed && depth < deepest && bound > allowed) {
    const HalvedCells parts = halve(cell, middle);
    if (parts.first.count >= 3 && parts.second.count >= 3) {
      place(parts.first, unhidden, whole, tolerance, depth + 1);
      place(parts.second, unhidden, whole, tolerance, depth + 1);
      return;
    }
  }
  error_ += std::min(error, bound);
  add_points(cell, std::max(order, 1), points_);
}

HiddenIntegral HiddenQuadrature::smooth(std::span<const Polygon> cells, double unhidden, double whole,
                                        double tolerance) {
  points_.clear();
  error_ = 0;
  for (const Polygon& cell : cells) place(cell, unhidden, whole, tolerance, 0);
  hidden_shares(points_, normal_, inner_, shadows_, workspace_, shares_);
  HiddenIntegral sum;
  for (std::size_t k = 0; k < shares_.size(); ++k) sum.value += points_.weight[k] * shares_[k];
  sum.error = error_;
  sum.points = static_cast<std::int64_t>(points_.size());
  return sum;
}

// Where none of the rules' points sees anything hidden: the largest hidden share at a corner. Where all see
// everything hidden: the largest share that is left. Else 0.
double HiddenQuadrature::corner_excess(std::size_t begin, std::size_t corners, std::size_t end) const {
  const auto largest = [&](const auto& excess) {
    for (std::size_t k = begin; k < corners; ++k) {
      if (excess(k) > 0) return 0.0;
    }
    double found = 0;
    for (std::size_t k = corners; k < end; ++k) found = std::max(found, excess(k));
    return found;
  };
  return std::max(largest([&](std::size_t k) { return shares_[k]; }),
                  largest([&](std::size_t k) { return left_over(k); }));
}

HiddenIntegral HiddenQuadrature::kinked(std::span<const Polygon> cells, double whole, double tolerance,
                                        int halvings) {
  return halved_to(cells, whole, tolerance, add_equal_rules, halvings);
}

HiddenIntegral HiddenQuadrature::cut(std::span<const Polygon> cells, double whole, double tolerance) {
  double each = tolerance;
  HiddenIntegral sum = halved_to(cells, whole, each, add_nested_rules);
  for (int attempt = 1; attempt < attempts && sum.error > tolerance; ++attempt) {
    each *= 0.5 * tolerance / sum.error;
    sum = halved_to(cells, whole, each, add_nested_rules);
  }
  return sum;
}

HiddenIntegral HiddenQuadrature::halved_to(std::span<const Polygon> cells, double whole, double tolerance,
                                           RulePair (*add_rules)(const Polygon&, OuterPoints&),
                                           int halvings) {
  const bool watch_corners = !shadows_.turning.empty();
  struct Part {
    Polygon cell;
    int depth;
  };
  std::vector<Part> parts, next;
  std::vector<RulePair> rules;
  auto put = [](std::vector<Part>& into, const Polygon& cell, int depth) {
    for (const Polygon& part : triangles_and_quads(cell)) into.push_back({part, depth});
  };
  for (const Polygon& cell : cells) put(parts, cell, 0);

  HiddenIntegral sum;
  while (!parts.empty()) {
    points_.clear();
    rules.clear();
    for (const Part& part : parts) {
      rules.push_back(add_rules(part.cell, points_));
      if (watch_corners) add_corners(part.cell, points_);
    }
    hidden_shares(points_, normal_, inner_, shadows_, workspace_, shares_);
    sum.points += static_cast<std::int64_t>(points_.size());
    next.clear();
    std::size_t at = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Part& part = parts[p];
      const RulePair& rule = rules[p];
      double first = 0, second = 0, size = 0;
      const std::size_t begin = at;
      for (std::size_t k = 0; k < rule.first; ++k, ++at) {
        first += points_.weight[at] * shares_[at];
        size += points_.weight[at];
      }
      for (std::size_t k = 0; k < rule.second; ++k, ++at) second += points_.weight[at] * shares_[at];
      const double value = rule.trust * first + (1 - rule.trust) * second;
      const double error = rule.trust * std::abs(first - second);
      const double allowed = tolerance * std::sqrt(size / whole);
      bool halve_it = error > allowed || part.depth < halvings;
      if (watch_corners) {
        const std::size_t end = at + static_cast<std::size_t>(part.cell.count);
        halve_it = halve_it || corner_share * size * corner_excess(begin, at, end) > allowed;
        at = end;
      }
      if (halve_it && part.depth < deepest) {
        const HalvedCells smaller = halve(part.cell, centroid(part.cell));
        put(next, smaller.first, part.depth + 1);
        put(next, smaller.second, part.depth + 1);
      } else {
        sum.value += value;
        sum.error += error;
      }
    }
    parts.swap(next);
  }
  return sum;
}

double HiddenQuadrature::left_over(std::size_t k) const {
  const std::span corners(inner_.corners.data(), static_cast<std::size_t>(inner_.count));
  const Vec3 eye(points_.x[k], points_.y[k], points_.z[k]);
  const double all = point_form_factor(eye, normal_, corners);
  return shares_[k] >= (1 - covered_rounding) * all ? 0 : all - shares_[k];
}

bool HiddenQuadrature::cover(const Polygon& cell) {
  points_.clear();
  add_points(cell, 3, points_);
  hidden_shares(points_, normal_, inner_, shadows_, workspace_, shares_);
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    if (left_over(k) > 0) return false;
  }
  return true;
}

}  // namespace luxel
