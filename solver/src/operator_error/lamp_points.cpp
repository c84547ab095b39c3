#include "operator_error/lamp_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace luxel {

namespace {

// Groups of emitting patches that share a distance from where one looks.
constexpr int most_groups = 64;

// Normals that differ by less [1 - cosine] are one.
constexpr double parallel = 1e-9;

double reach_of(const PatchMesh& mesh, int patch, const Vec3& middle) {
  double reach = 0;
  for (int k = 0; k < mesh.corner_count(patch); ++k) {
    reach = std::max(reach, (mesh.vertices[mesh.corners[patch][k]] - middle).norm());
  }
  return reach;
}

}  // namespace

LampPoints::LampPoints(const PatchMesh& mesh, const PatchField& emission, std::span<const int> order,
                       double most)
    : mesh_(mesh), emitter_of_(mesh.size(), -1) {
  double power = 0, emitting = 0, all = 0;
  for (const int patch : order) {
    all += mesh.areas[patch];
    const double exitance = emission.row(patch).sum();
    if (!(exitance > 0)) continue;
    emitter_of_[patch] = static_cast<int>(emitters_.size());
    emitters_.push_back(patch);
    exitance_.push_back(exitance);
    up_to_.push_back(power += exitance * mesh.areas[patch]);
    emitting += mesh.areas[patch];
  }
  if (emitting > most * all) {
    emitters_.clear();
    emitter_of_.assign(mesh.size(), -1);
  }
  if (emitters_.empty()) return;
  squares_.reserve(emitters_.size());
  for (const int patch : emitters_) {
    squares_.emplace_back(mesh, patch);
    normals_.push_back(mesh.normals[patch]);
  }

  // pieces of about equal power, of one normal each where the next would turn
  group_of_.resize(emitters_.size());
  double before = 0;
  for (int k = 0; k < static_cast<int>(emitters_.size()); ++k) {
    const Vec3& normal = mesh.normals[emitters_[k]];
    const bool full = up_to_[k] - before > power / most_groups * 2;
    const bool turned = !groups_.empty() && 1 - normal.dot(groups_.back().normal) > parallel;
    if (groups_.empty() || full || (turned && static_cast<int>(groups_.size()) < most_groups)) {
      if (k > 0) before = up_to_[k - 1];
      groups_.push_back({k, k, 0, Vec3::Zero(), 0, normal});
    } else if (turned) {
      groups_.back().normal.setZero();
    }
    group_of_[k] = static_cast<int>(groups_.size()) - 1;
    groups_.back().end = k + 1;
  }
  for (Group& group : groups_) {
    for (int k = group.first; k < group.end; ++k) {
      const double of_patch = up_to_[k] - (k > 0 ? up_to_[k - 1] : 0);
      group.power += of_patch;
      group.middle += of_patch * mesh.centroids[emitters_[k]];
    }
    group.middle /= group.power;
    for (int k = group.first; k < group.end; ++k) {
      group.radius = std::max(group.radius, reach_of(mesh, emitters_[k], group.middle));
    }
  }
}

LampPoints::View::View(const LampPoints& lamps, int patch) : lamps_(lamps) {
  const PatchMesh& mesh = lamps.mesh_;
  const Vec3& middle = mesh.centroids[patch];
  const double reach = reach_of(mesh, patch, middle);
  double sum = 0;
  for (const Group& group : lamps.groups_) {
    const Vec3 way = group.middle - middle;
    const bool below = mesh.normals[patch].dot(way) < -(group.radius + reach);
    const bool behind = !group.normal.isZero() && group.normal.dot(way) > reach;
    const double distance = std::max(way.norm(), group.radius);
    chance_.push_back(below || behind ? 0 : group.power / (distance * distance));
    up_to_.push_back(sum += chance_.back());
  }
  if (!(sum > 0)) {
    up_to_.clear();
    return;
  }
  for (double& chance : chance_) chance /= sum;
  for (double& chance : up_to_) chance /= sum;
}

LampPoints::Point LampPoints::View::point(double s, double t) const {
  const auto chosen =
      std::min(static_cast<std::size_t>(std::upper_bound(up_to_.begin(), up_to_.end(), s) - up_to_.begin()),
               up_to_.size() - 1);
  const Group& group = lamps_.groups_[chosen];
  s = std::clamp((s - (chosen > 0 ? up_to_[chosen - 1] : 0)) / chance_[chosen], 0.0, 1.0);
  const auto& powers = lamps_.up_to_;
  const double before = group.first > 0 ? powers[group.first - 1] : 0;
  const double at = before + s * group.power;
  const auto found = std::upper_bound(powers.begin() + group.first, powers.begin() + group.end, at);
  const int k = std::min(static_cast<int>(found - powers.begin()), group.end - 1);
  const double up_to_here = k > 0 ? powers[k - 1] : 0;
  s = std::clamp((at - up_to_here) / (powers[k] - up_to_here), 0.0, 1.0);
  Point point;
  point.patch = lamps_.emitters_[k];
  point.at = lamps_.squares_[k](s, t);
  point.normal = lamps_.normals_[k];
  point.density = density(point.patch);
  return point;
}

double LampPoints::View::density(int patch) const {
  const int k = lamps_.emitter_of_[patch];
  if (k < 0 || empty()) return 0;
  const int group = lamps_.group_of_[k];
  return chance_[group] * lamps_.exitance_[k] / lamps_.groups_[group].power;
}

}  // namespace luxel
