#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "rays/front_part.h"

struct RTCSceneTy;

namespace luxel {

/// Two flat ends that may see each other, in the coordinates of the rays.
struct SightEnds {
  FrontPart receiver, source;   ///< of each what lies in front of the other's plane
  Vec3 normal, source_normal;   ///< unit
  double source_offset = 0;     ///< source_normal . x where rays to the source end
  bool close = false;           ///< draw by the cosine too
  bool source_is_part = false;  ///< the source's points are all on it: only those of its plane need be asked
  std::function<bool(const Vec3&)> on_source;  ///< whether a point of the source's plane is on it
};

/// What share of the light that goes from one end to the other is not hidden, by rays between quasi-random
/// points, each of which weighs what it would carry. Where ends are close or touch, such weights have
/// infinite variance: then as many rays again start by the cosine and count if they end on the source, and
/// the balance heuristic weighs both. Source: Veach and Guibas 1995.
class VisibleShare {
 public:
  static constexpr int packet = 16;

  VisibleShare(const SightEnds& ends, RTCSceneTy* scene, std::uint64_t seed);

  /// Casts rays for the next `count` points, at most `packet`. Points of the ends that do not face each other
  /// cost none.
  /// @param words  4 a point: those of Sobol's sequence with their bits reversed
  void draw(int count, const std::uint32_t* words);

  int rays() const { return rays_; }
  bool some_visible() const { return some_visible_; }
  bool some_hidden() const { return some_hidden_; }
  /// Of the light that would arrive if nothing hid any; 0 before any ray.
  double share() const { return all_ > 0 ? visible_ / all_ : 0; }
  /// Of as many rays of one weight the share would be as certain.
  double equal_rays() const { return squares_ > 0 ? all_ * all_ / squares_ : 0; }

 private:
  void cast(int count, const std::uint32_t* words, bool by_cosine);
  RayPoint met_by_cosine(const RayPoint& from, float s, float t) const;
  double weight(const RayPoint& way) const;

  const SightEnds& ends_;
  RTCSceneTy* scene_;
  RayPoint normal_, tangent_, bitangent_, source_normal_;
  float source_offset_;
  double density_;  // of points of the source
  std::array<std::array<std::uint32_t, 4>, 2> seeds_;
  int rays_ = 0;
  bool some_visible_ = false, some_hidden_ = false;
  double all_ = 0, visible_ = 0, squares_ = 0;
};

}  // namespace luxel
