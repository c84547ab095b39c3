#include "transport/gather/gather_rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "enclosures/hemisphere_rays.h"
#include "sampling/owen_sobol.h"
#include "sampling/sobol_words.h"
#include "transport/gather/packets.h"
#include "transport/gather/patch_frame.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Backs that an open enclosure's ray meets nearer than this, in the ray scene's coordinates, may be the
// rounding of an origin beside an edge.
constexpr float near_back = 1e-5f;

// Fresh directions tried for a ray of a closed enclosure that is lost for good: one in 10^6 of the rays
// beside a crack, at most.
constexpr int replacements = 8;

// Streams of random numbers, all seeded by patch or packet.
constexpr std::uint64_t own_stream = 0x67617468, shared_stream = 0x73686172, replacement_stream = 0x7265706c;

/// Shared upper digits of each of a direction's two numbers: with half the net's digits in each, no two rays
/// of a patch share them all.
int shared_digits(int count) {
  int digits = 0;
  while (1 << 2 * digits < count) ++digits;
  return digits;
}

}  // namespace

GatherRays::GatherRays(const PatchMesh& mesh, const RayScene& occluders, const Enclosures& enclosures,
                       int count, std::uint64_t seed)
    : mesh_(mesh),
      occluders_(occluders),
      enclosures_(enclosures),
      count_(count),
      seed_(seed),
      packets_(packets_of(mesh)),
      map_(mesh),
      words_(reversed_sobol_words(count)) {
  if (enclosures.count > 1) {
    enclosure_of_.assign(enclosures.enclosure.begin(), enclosures.enclosure.end());
    enclosure_of_.push_back(-1);
  }
  scene_.embree = occluders.embree_scene();
  scene_.words = words_.data();
  scene_.lower_digits = 0xffffffffu >> shared_digits(count);
  scene_.map = &map_;
  scene_.nothing = mesh.size();
  scene_.enclosures = enclosure_of_.empty() ? nullptr : enclosure_of_.data();
  scene_.near_back = near_back;
}

std::size_t GatherRays::bytes() const {
  return packets_.size() * sizeof(packets_[0]) + map_.bytes() + 4 * (words_.size() + enclosure_of_.size());
}

const PatchLocator& GatherRays::locator() const {
  std::call_once(locator_made_, [this] { locator_ = std::make_unique<PatchLocator>(mesh_); });
  return *locator_;
}

PacketFrame GatherRays::frame_of(const GatherOperator::Packet& packet) const {
  PacketFrame frame;
  const Vec3 tangent = mesh_.normals[packet[0]].unitOrthogonal();
  for (int k = 0; k < lanes; ++k) {
    const int patch = packet[k] >= 0 ? packet[k] : packet[0];
    const PatchFrame own = patch_frame(mesh_, patch, occluders_);
    // neighbours turn their frames alike, so that equal numbers are nearly equal directions
    Vec3 aligned = tangent - tangent.dot(own.normal) * own.normal;
    if (aligned.norm() < 0.1) aligned = own.normal.unitOrthogonal();
    aligned.normalize();
    const Vec3 bitangent = own.normal.cross(aligned);
    for (int c = 0; c < 3; ++c) {
      frame.corner[c][k] = static_cast<float>(own.corner[c]);
      frame.first[c][k] = static_cast<float>(own.first[c]);
      frame.second[c][k] = static_cast<float>(own.second[c]);
      frame.third[c][k] = static_cast<float>(own.third[c]);
      frame.normal[c][k] = static_cast<float>(own.normal[c]);
      frame.tangent[c][k] = static_cast<float>(aligned[c]);
      frame.bitangent[c][k] = static_cast<float>(bitangent[c]);
    }
    frame.share[k] = static_cast<float>(own.share);
    const std::uint64_t seed = mixed_seed(seed_ ^ own_stream, patch);
    for (int q = 0; q < 4; ++q) frame.seeds[q][k] = static_cast<std::uint32_t>(mixed_seed(seed, q));
    const int enclosure = enclosures_.enclosure[patch];
    frame.enclosure[k] = enclosures_.enclosure_closed[enclosure] ? enclosure : -1;
    frame.valid[k] = packet[k] >= 0 ? -1 : 0;
  }
  const std::uint64_t seed = mixed_seed(seed_ ^ shared_stream, packet[0]);
  for (int q = 0; q < 2; ++q) frame.shared_seeds[q] = static_cast<std::uint32_t>(mixed_seed(seed, q));
  return frame;
}

void GatherRays::trace(std::size_t packet, int first, int count, std::uint32_t* met) const {
  const PacketFrame frame = frame_of(packets_[packet]);
  std::vector<DoubtfulRay> doubtful;
  trace_packet(scene_, frame, first, count, met, doubtful);
  for (const DoubtfulRay& ray : doubtful) {
    const int patch = packets_[packet][ray.lane];
    met[static_cast<std::size_t>(ray.ray) * lanes + ray.lane] =
        settle(patch, ray, mixed_seed(seed_ ^ replacement_stream, first + ray.ray));
  }
  asked_twice_ += static_cast<std::int64_t>(doubtful.size());
}

/// The patch that a ray meets, in double precision; -1 for nothing, or in a closed enclosure for a patch of
/// another.
int GatherRays::patch_met(int patch, const Vec3& origin, const Vec3& direction) const {
  RayScene::Hit hit;
  occluders_.intersect({&origin, 1}, {&mesh_.normals[patch], 1}, {&direction, 1}, {&hit, 1});
  if (hit.primitive < 0) return -1;
  const int met = locator().patch_at(hit.primitive, hit.front, origin + hit.distance * direction);
  const int home = enclosures_.enclosure[patch];
  const bool leaked = met >= 0 && enclosures_.enclosure_closed[home] && enclosures_.enclosure[met] != home;
  return leaked ? -1 : met;
}

std::uint32_t GatherRays::settle(int patch, const DoubtfulRay& ray, std::uint64_t stream) const {
  const auto vector = [](const float* x) { return Vec3(x[0], x[1], x[2]); };
  Vec3 origin = vector(ray.origin) / occluders_.scale() + occluders_.centre();
  const Vec3& normal = mesh_.normals[patch];
  origin -= normal.dot(origin - mesh_.centroids[patch]) * normal;
  const int met = patch_met(patch, origin, vector(ray.direction).normalized());
  if (met >= 0) return static_cast<std::uint32_t>(met);
  if (enclosures_.enclosure_closed[enclosures_.enclosure[patch]]) {
    const HemisphereRays others =
        hemisphere_rays(mesh_, patch, replacements, mixed_seed(stream, patch), outline_margin(occluders_));
    for (int k = 0; k < replacements; ++k) {
      const int other = patch_met(patch, others.origins[k], others.directions[k]);
      if (other >= 0) return static_cast<std::uint32_t>(other);
    }
  }
  return static_cast<std::uint32_t>(mesh_.size());
}

}  // namespace luxel
