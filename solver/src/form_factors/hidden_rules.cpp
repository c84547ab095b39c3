#include "form_factors/hidden_rules.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

namespace luxel {

namespace {

// Points move off symmetric places by this share of their cell, so that none lies in a plane through two
// parallel edges of different shadows, where rounding would decide which of the two is in front. Far above
// rounding (1e-16), far below any error asked for.
constexpr double nudge = 1e-9;

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

// Two rules of degree 3 on a quad: Gauss, and four points on the axes.
constexpr double g = 0.5 / std::numbers::sqrt3, axis = 0.40824829046386302;  // sqrt(2/3) / 2
constexpr std::array<Node, 8> quad_rules{{{0.5 - g, 0.5 - g, 0.25},
                                          {0.5 + g, 0.5 - g, 0.25},
                                          {0.5 - g, 0.5 + g, 0.25},
                                          {0.5 + g, 0.5 + g, 0.25},
                                          {0.5 - axis, 0.5, 0.25},
                                          {0.5 + axis, 0.5, 0.25},
                                          {0.5, 0.5 - axis, 0.25},
                                          {0.5, 0.5 + axis, 0.25}}};

// The second rule of degree 2 on a triangle.
constexpr std::array<Node, 3> triangle_middles{{{0.5, 0, 1.0 / 3}, {0.5, 0.5, 1.0 / 3}, {0, 0.5, 1.0 / 3}}};

}  // namespace

void add_points(const Polygon& cell, int order, OuterPoints& points) {
  fan(
      cell,
      [&](const std::array<Vec3, 3>& t) { add_triangle(t[0], t[1], t[2], triangle_rule(order), points); },
      [&](const std::array<Vec3, 4>& q) { add_quad(q, order, points); });
}

RulePair add_equal_rules(const Polygon& c, OuterPoints& points) {
  if (c.count == 4) {
    const QuadMap map({c[0], c[1], c[2], c[3]});
    for (const Node& node : quad_rules) map.add(node.u, node.v, node.weight, points);
    return {4, 4, 0.5};
  }
  add_triangle(c[0], c[1], c[2], triangle_2, points);
  add_triangle(c[0], c[1], c[2], triangle_middles, points);
  return {3, 3, 0.5};
}

RulePair add_nested_rules(const Polygon& c, OuterPoints& points) {
  add_points(c, 3, points);
  add_points(c, 2, points);
  return c.count == 4 ? RulePair{9, 4, 1} : RulePair{6, 3, 1};
}

void add_corners(const Polygon& cell, OuterPoints& points) {
  constexpr double inwards = 1e-6;
  const Vec3 middle = centroid(cell);
  for (int k = 0; k < cell.count; ++k) points.add(cell[k] + inwards * (middle - cell[k]), 0);
}

std::vector<Polygon> triangles_and_quads(const Polygon& cell) {
  std::vector<Polygon> parts;
  auto add = [&parts](const auto& corners) {
    Polygon part;
    part.count = static_cast<int>(corners.size());
    std::copy(corners.begin(), corners.end(), part.corners.begin());
    parts.push_back(part);
  };
  fan(cell, add, add);
  return parts;
}

}  // namespace luxel
