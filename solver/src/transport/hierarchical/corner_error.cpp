#include "transport/hierarchical/corner_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace luxel {

double corner_error(const BlockEnd& flat, const BlockEnd& other, const std::array<double, 16>& at_nodes) {
  std::array<double, 4> means{};
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) means[a] += other.weights[b] * at_nodes[4 * a + b];
  }
  const Vec3& normal = flat.bounds.plane.normal;
  double largest = 0;
  for (int k = 0; k < flat.bounds.hull.count; ++k) {
    const Vec3& corner = flat.bounds.hull[k];
    double error = 0;
    for (int b = 0; b < 4; ++b) {
      const Vec3 sight(other.x[b] - corner.x(), other.y[b] - corner.y(), other.z[b] - corner.z());
      const double from = std::max(normal.dot(sight), 0.0);
      const double to = std::max(-sight.dot(Vec3(other.nx[b], other.ny[b], other.nz[b])), 0.0);
      const double squared = sight.squaredNorm();
      error += other.weights[b] * from * to / (std::numbers::pi * squared * squared);
    }
    const std::array<double, 4> functions = flat.axes.functions(corner);
    for (int a = 0; a < 4; ++a) error -= functions[a] * means[a];
    largest = std::max(largest, std::abs(error));
  }
  return largest;
}

}  // namespace luxel
