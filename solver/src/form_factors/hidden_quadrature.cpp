#include "form_factors/hidden_quadrature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "luxel/form_factors.h"

namespace luxel {

namespace {

// Points move off symmetric places by this share of their cell, so that none lies in a plane through two
// parallel edges of different shadows, where rounding would decide which of the two is in front. Far above
// rounding (1e-16), far below any error asked for.
constexpr double nudge = 1e-9;

// Within a smooth cell the hidden area is a polynomial of degree two in the point as long as the cell's
// radius r is small against its distance D from the nearest edge, with corrections by powers of r / D: a
// one-point rule errs by about this share, one of order n > 1 by this times (2 D / r)^(2 - 2 n). Measured on
// rooms and rotated boxes, see docs/decisions/0007-visibility.md.
constexpr double gauss_constant = 0.1;

// Cells are halved at most so often on their way to an edge that touches them; what is left then is
// 2^-depth of the patch.
constexpr int deepest = 12;

constexpr int highest_order = 4;

// What a sum of arcs around a hidden polygon loses to rounding, and a patch to the gap between welded faces.
constexpr double covered_rounding = 1e-9;

struct Node {
  double u, v, weight;
};

// Gauss-Legendre on [0, 1].
struct Gauss {
  std::array<double, 4> at{}, weight{};
};
constexpr std::array<Gauss, 4> gauss{{
    {{0.5}, {1.0}},
    {{0.21132486540518713, 0.78867513459481287}, {0.5, 0.5}},
    {{0.11270166537925831, 0.5, 0.88729833462074169}, {5.0 / 18, 8.0 / 18, 5.0 / 18}},
    {{0.069431844202973713, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629},
     {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}},
}};

// Symmetric rules on triangles, barycentric; Dunavant 1985.
constexpr std::array<Node, 1> triangle_1{{{1.0 / 3, 1.0 / 3, 1}}};
constexpr std::array<Node, 3> triangle_2{
    {{1.0 / 6, 1.0 / 6, 1.0 / 3}, {2.0 / 3, 1.0 / 6, 1.0 / 3}, {1.0 / 6, 2.0 / 3, 1.0 / 3}}};
constexpr double a4 = 0.445948490915965, b4 = 0.091576213509771, wa4 = 0.223381589678011,
                 wb4 = 0.109951743655322;
constexpr std::array<Node, 6> triangle_4{{{a4, a4, wa4},
                                          {1 - 2 * a4, a4, wa4},
                                          {a4, 1 - 2 * a4, wa4},
                                          {b4, b4, wb4},
                                          {1 - 2 * b4, b4, wb4},
                                          {b4, 1 - 2 * b4, wb4}}};
constexpr double a6 = 0.249286745170910, b6 = 0.063089014491502, c6 = 0.310352451033785,
                 d6 = 0.053145049844816, wa6 = 0.116786275726379, wb6 = 0.050844906370207,
                 wc6 = 0.082851075618374;
constexpr std::array<Node, 12> triangle_6{{{a6, a6, wa6},
                                           {1 - 2 * a6, a6, wa6},
                                           {a6, 1 - 2 * a6, wa6},
                                           {b6, b6, wb6},
                                           {1 - 2 * b6, b6, wb6},
                                           {b6, 1 - 2 * b6, wb6},
                                           {c6, d6, wc6},
                                           {d6, c6, wc6},
                                           {c6, 1 - c6 - d6, wc6},
                                           {1 - c6 - d6, c6, wc6},
                                           {d6, 1 - c6 - d6, wc6},
                                           {1 - c6 - d6, d6, wc6}}};

std::span<const Node> triangle_rule(int order) {
  switch (order) {
    case 1:
      return triangle_1;
    case 2:
      return triangle_2;
    case 3:
      return triangle_4;
    default:
      return triangle_6;
  }
}

void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::span<const Node> rule,
                  OuterPoints& points) {
  const Vec3 u = b - a, v = c - a;
  const double size = 0.5 * u.cross(v).norm();
  for (const Node& node : rule) {
    points.add(a + (node.u + 0.61 * nudge) * u + (node.v + 0.37 * nudge) * v, size * node.weight);
  }
}

// The bilinear map from the unit square to a flat quad, and its area element, which is linear in both.
class QuadMap {
 public:
  explicit QuadMap(const std::array<Vec3, 4>& q)
      : origin_(q[0]), s_(q[1] - q[0]), t_(q[3] - q[0]), both_(q[0] - q[1] + q[2] - q[3]) {
    const Vec3 normal = (q[2] - q[0]).cross(q[3] - q[1]).normalized();
    element_ = normal.dot(s_.cross(t_));
    element_s_ = normal.dot(s_.cross(both_));
    element_t_ = normal.dot(both_.cross(t_));
  }
  void add(double s, double t, double weight, OuterPoints& points) const {
    const double u = s + 0.61 * nudge, v = t + 0.37 * nudge;
    points.add(origin_ + u * s_ + v * t_ + u * v * both_,
               weight * std::max(element_ + s * element_s_ + t * element_t_, 0.0));
  }

 private:
  Vec3 origin_, s_, t_, both_;
  double element_, element_s_, element_t_;
};

void add_quad(const std::array<Vec3, 4>& q, int order, OuterPoints& points) {
  const Gauss& rule = gauss[static_cast<std::size_t>(order - 1)];
  const QuadMap map(q);
  for (int i = 0; i < order; ++i) {
    for (int j = 0; j < order; ++j) {
      map.add(rule.at[i], rule.at[j], rule.weight[i] * rule.weight[j], points);
    }
  }
}

// Triangles and quads of a fan around the first corner.
template <class OnTriangle, class OnQuad>
void fan(const Polygon& cell, OnTriangle on_triangle, OnQuad on_quad) {
  int k = 1;
  for (; k + 2 < cell.count; k += 2) on_quad(std::array{cell[0], cell[k], cell[k + 1], cell[k + 2]});
  if (k + 1 < cell.count) on_triangle(std::array{cell[0], cell[k], cell[k + 1]});
}

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

void add_points(const Polygon& cell, int order, OuterPoints& points) {
  fan(
      cell,
      [&](const std::array<Vec3, 3>& t) { add_triangle(t[0], t[1], t[2], triangle_rule(order), points); },
      [&](const std::array<Vec3, 4>& q) { add_quad(q, order, points); });
}

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

HiddenIntegral HiddenQuadrature::adaptive(std::span<const Polygon> cells, double whole, double tolerance) {
  // two rules of degree 3 on a quad: Gauss, and the four points on the axes; two of degree 2 on a triangle
  constexpr double g = 0.5 / std::numbers::sqrt3, axis = 0.40824829046386302;  // sqrt(2/3) / 2
  constexpr std::array<Node, 8> quad_rules{{{0.5 - g, 0.5 - g, 0.25},
                                            {0.5 + g, 0.5 - g, 0.25},
                                            {0.5 - g, 0.5 + g, 0.25},
                                            {0.5 + g, 0.5 + g, 0.25},
                                            {0.5 - axis, 0.5, 0.25},
                                            {0.5 + axis, 0.5, 0.25},
                                            {0.5, 0.5 - axis, 0.25},
                                            {0.5, 0.5 + axis, 0.25}}};
  constexpr std::array<Node, 3> triangle_middles{{{0.5, 0, 1.0 / 3}, {0.5, 0.5, 1.0 / 3}, {0, 0.5, 1.0 / 3}}};

  struct Part {
    Polygon cell;
    int depth;
  };
  std::vector<Part> parts, next;
  auto put = [](std::vector<Part>& into, const Polygon& cell, int depth) {
    fan(
        cell,
        [&](const std::array<Vec3, 3>& t) {
          Polygon p;
          p.count = 3;
          std::copy(t.begin(), t.end(), p.corners.begin());
          into.push_back({p, depth});
        },
        [&](const std::array<Vec3, 4>& q) {
          Polygon p;
          p.count = 4;
          std::copy(q.begin(), q.end(), p.corners.begin());
          into.push_back({p, depth});
        });
  };
  for (const Polygon& cell : cells) put(parts, cell, 0);

  HiddenIntegral sum;
  while (!parts.empty()) {
    points_.clear();
    for (const Part& part : parts) {
      const Polygon& c = part.cell;
      if (c.count == 4) {
        const QuadMap map({c[0], c[1], c[2], c[3]});
        for (const Node& node : quad_rules) map.add(node.u, node.v, node.weight, points_);
      } else {
        add_triangle(c[0], c[1], c[2], triangle_2, points_);
        add_triangle(c[0], c[1], c[2], triangle_middles, points_);
      }
    }
    hidden_shares(points_, normal_, inner_, shadows_, workspace_, shares_);
    sum.points += static_cast<std::int64_t>(points_.size());
    next.clear();
    std::size_t at = 0;
    for (const Part& part : parts) {
      const std::size_t half = part.cell.count == 4 ? 4 : 3;
      double first = 0, second = 0, size = 0;
      for (std::size_t k = 0; k < half; ++k) {
        first += points_.weight[at + k] * shares_[at + k];
        second += points_.weight[at + half + k] * shares_[at + half + k];
        size += points_.weight[at + k];
      }
      at += 2 * half;
      const double error = 0.5 * std::abs(first - second), allowed = tolerance * std::sqrt(size / whole);
      if (error > allowed && part.depth < deepest) {
        const HalvedCells smaller = halve(part.cell, centroid(part.cell));
        put(next, smaller.first, part.depth + 1);
        put(next, smaller.second, part.depth + 1);
      } else {
        sum.value += 0.5 * (first + second);
        sum.error += error;
      }
    }
    parts.swap(next);
  }
  return sum;
}

bool HiddenQuadrature::cover(const Polygon& cell) {
  points_.clear();
  add_points(cell, 3, points_);
  hidden_shares(points_, normal_, inner_, shadows_, workspace_, shares_);
  const std::span corners(inner_.corners.data(), static_cast<std::size_t>(inner_.count));
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const Vec3 eye(points_.x[k], points_.y[k], points_.z[k]);
    if (shares_[k] < (1 - covered_rounding) * point_form_factor(eye, normal_, corners)) return false;
  }
  return true;
}

}  // namespace luxel
