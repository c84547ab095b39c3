#pragma once

#include "form_factors/polygon.h"

namespace luxel {

/// Up to `capacity` points with a vector weight each, in the layout of the vector kernels.
struct PointBatch {
  static constexpr int capacity = 128;
  int count = 0;
  alignas(64) double x[capacity], y[capacity], z[capacity];
  alignas(64) double wx[capacity], wy[capacity], wz[capacity];
};

/// Sum over the points x of w . integral of ln |x - y| dy around the polygon, the edge integrals in closed
/// form. Around one polygon's contour, with w = weight times tangent, this is 2 pi times the exchange area
/// (Sparrow 1963).
double log_contour(PointBatch& points, const Polygon& polygon);

/// Sum over the points x with w = weight times the unit normal of Lambert's (1760) share of the polygon in
/// the point's view; the polygon lies in front of the points and faces them.
double lambert_sum(PointBatch& points, const Polygon& polygon);

/// Sum over point pairs of (w_x . d)(w_y . -d) / (pi |d|^4), d = y - x, w = weight times the unit normal.
double point_pair_sum(const PointBatch& a, PointBatch& b);

}  // namespace luxel
