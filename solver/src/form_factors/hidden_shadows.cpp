#include <Eigen/Geometry>
#include <cstdint>

#include "form_factors/hidden_kernel.h"

namespace luxel {

namespace {

// Two edges lie on one line where their directions, and their moments about the origin, agree to this, in
// working coordinates: the noise of files with 12 digits.
constexpr double same_line = 1e-11;

}  // namespace

void OuterPoints::clear() {
  x.clear();
  y.clear();
  z.clear();
  weight.clear();
}

void OuterPoints::add(const Vec3& point, double point_weight) {
  x.push_back(point.x());
  y.push_back(point.y());
  z.push_back(point.z());
  weight.push_back(point_weight);
}

void Shadows::clear() {
  edges.clear();
  begin.assign(1, 0);
  cut.clear();
  turning.clear();
  ties.clear();
}

double* HiddenWorkspace::reserve(std::size_t size) {
  constexpr std::size_t alignment = 128;
  if (memory_.size() < size + alignment / sizeof(double)) memory_.resize(size + alignment / sizeof(double));
  const auto address = reinterpret_cast<std::uintptr_t>(memory_.data());
  return memory_.data() + ((alignment - address % alignment) % alignment) / sizeof(double);
}

void find_ties(Shadows& shadows) {
  const std::size_t count = shadows.edges.size();
  shadows.ties.assign(shadows.count() > 1 ? count * count : 0, 0);
  if (shadows.count() < 2) return;
  std::vector<Vec3> along(count), moment(count);
  for (std::size_t e = 0; e < count; ++e) {
    along[e] = (shadows.edges[e].q - shadows.edges[e].p).normalized();
    moment[e] = shadows.edges[e].p.cross(along[e]);
  }
  for (std::size_t e = 0; e < count; ++e) {
    for (std::size_t o = 0; o < e; ++o) {
      const double sign = along[e].dot(along[o]) < 0 ? -1 : 1;
      if ((along[e] - sign * along[o]).squaredNorm() > same_line * same_line ||
          (moment[e] - sign * moment[o]).squaredNorm() > same_line * same_line) {
        continue;
      }
      shadows.ties[e * count + o] = shadows.ties[o * count + e] = static_cast<signed char>(sign);
    }
  }
}

}  // namespace luxel
