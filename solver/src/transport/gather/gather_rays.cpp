#include "transport/gather/gather_rays.h"

#include <hwy/cache_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "enclosures/cells.h"
#include "enclosures/hemisphere_rays.h"
#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "sampling/owen_sobol.h"
#include "transport/gather/packets.h"
#include "transport/gather/patch_frame.h"
#include "transport/gather/sorted_rays.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Lost rays of a packet that are asked again before the rest is believed, unless one in so many proves wrong.
constexpr int lost_for_certain = 4, wrong_among = 8;

// Fresh directions tried for a ray of a closed enclosure that is lost for good: one in 10^6 of the rays
// beside a crack, at most.
constexpr int replacements = 8;

// Streams of random numbers, all seeded by patch or packet.
constexpr std::uint64_t own_stream = 0x67617468, shared_stream = 0x73686172, replacement_stream = 0x7265706c,
                        single_stream = 0x73696e67, sample_stream = 0x73616d70;

// Rays that trace_sample() can be asked for.
constexpr int most_rays_sampled = 1024;

// With more triangles a packet shares whole directions: through small triangles, rays that are nearly
// parallel part too soon, and where little is merged there is no plane over which neighbours' noise could be
// fitted.
constexpr std::size_t large_scene = 100'000;

// Packets whose rays are sorted together: 8,192 patches; at 64 rays from each some 20 MB for each thread.
constexpr std::size_t sorted_packets = 512;
constexpr int sorted_rays = 64;

// Share of a quad's area in its second triangle, below which no point falls there.
constexpr double least_share = 0x1p-24;

// Rays of one packet between two visits to the sums: their patches, 32 kB, stay in the first cache or close
// by.
constexpr int rays_a_visit = 512;

// Rays of one packet after which the doubtful ones are settled.
constexpr int rays_a_doubt = 64;

/// Whether most packets hold patches of many polygons in a large scene.
bool rough(const PatchMesh& mesh) {
  return mesh.occluders.triangles.size() > large_scene &&
         mesh.size() < 2 * lanes * static_cast<double>(mesh.occluders.polygon_count);
}

/// Shared upper digits of each of a direction's two numbers: with half the net's digits in each, no two rays
/// of a patch share them all.
int shared_digits(int count) {
  int digits = 0;
  while (1 << 2 * digits < count) ++digits;
  return digits;
}

/// The cell that each patch looks into where it is proven to be closed, else -1; one more -1 for nothing.
std::vector<std::int32_t> closed_cells(const PatchMesh& mesh, const RayScene& occluders) {
  const TriangleSoup soup(mesh.occluders, occluders);
  const Cells cells = find_cells(soup, find_shells(soup), lit_sides(mesh), occluders);
  std::vector<std::int32_t> result = cells_of_patches(mesh, cells);
  for (std::int32_t& cell : result) {
    if (cell >= 0 && cells.proof[cell] != Proof::closed) cell = -1;
  }
  result.push_back(-1);
  return result;
}

}  // namespace

PatchNet::PatchNet(int count) : blocks_((count + lanes - 1) / lanes), words_(net_words(count)) {}

GatherRays::GatherRays(const PatchMesh& mesh, const RayScene& occluders, int count, std::uint64_t seed,
                       int most)
    : mesh_(mesh),
      occluders_(occluders),
      seed_(seed),
      packets_(packets_of(mesh)),
      map_(mesh, HitMap::texels_for(mesh.size(), std::max(count, most))),
      enclosures_(closed_cells(mesh, occluders)) {
  scene_.embree = occluders.embree_scene();
  set_count(count);
  if (rough(mesh)) together_ = sorted_packets;
  scene_.map = &map_;
  scene_.nothing = mesh.size();
  // with one cell for all there is no other to be met
  const bool one = std::all_of(enclosures_.begin(), enclosures_.end() - 1,
                               [&](std::int32_t cell) { return cell == enclosures_[0]; });
  scene_.enclosures = one ? nullptr : enclosures_.data();
}

std::size_t GatherRays::bytes() const {
  return packets_.size() * sizeof(packets_[0]) + map_.bytes() + 4 * (words_.size() + enclosures_.size());
}

const PatchLocator& GatherRays::locator() const {
  std::call_once(locator_made_, [this] { locator_ = std::make_unique<PatchLocator>(mesh_); });
  return *locator_;
}

/// Calls for all that frame_of() will read: patch by patch it would wait for each.
void GatherRays::call_for(const GatherOperator::Packet& packet) const {
  for (const int patch : packet) {
    if (patch < 0) return;
    hwy::Prefetch(&mesh_.centroids[patch]);
    hwy::Prefetch(&mesh_.normals[patch]);
    for (int k = 0; k < mesh_.corner_count(patch); ++k) {
      hwy::Prefetch(&mesh_.vertices[mesh_.corners[patch][k]]);
    }
  }
}

PacketFrame GatherRays::frame_of(const GatherOperator::Packet& packet, std::uint64_t seed_of_all) const {
  PacketFrame frame;
  call_for(packet);
  bool triangles = true, parallelograms = true;
  const Vec3 tangent = mesh_.normals[packet[0]].unitOrthogonal();
  Vec3 normal = Vec3::Zero(), aligned = normal, bitangent = normal;
  for (int k = 0; k < lanes; ++k) {
    const int patch = packet[k] >= 0 ? packet[k] : packet[0];
    const PatchFrame own = patch_frame(mesh_, patch, occluders_);
    if (own.normal != normal) {
      // neighbours turn their frames alike, so that equal numbers are nearly equal directions
      normal = own.normal;
      aligned = tangent - tangent.dot(normal) * normal;
      if (aligned.norm() < 0.1) aligned = normal.unitOrthogonal();
      aligned.normalize();
      bitangent = normal.cross(aligned);
    }
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
    frame.first_scale[k] = static_cast<float>(1 / own.share);
    frame.other_scale[k] = static_cast<float>(1 / std::max(1 - own.share, least_share));
    triangles = triangles && mesh_.corner_count(patch) == 3;
    parallelograms = parallelograms && own.parallelogram;
    const std::uint64_t seed = mixed_seed(seed_of_all ^ own_stream, patch);
    const std::uint64_t place = mixed_seed(seed, 0), direction = mixed_seed(seed, 1);
    frame.turned[0][k] = static_cast<std::uint32_t>(place);
    frame.turned[1][k] = static_cast<std::uint32_t>(place >> 32);
    frame.turned[2][k] = static_cast<std::uint32_t>(direction) & lower_digits_;
    frame.turned[3][k] = static_cast<std::uint32_t>(direction >> 32) & lower_digits_;
    frame.enclosure[k] = enclosures_[patch];
    frame.valid[k] = packet[k] >= 0 ? -1 : 0;
  }
  using Shape = PacketFrame::Shape;
  frame.shape = triangles ? Shape::triangles : parallelograms ? Shape::parallelograms : Shape::quads;
  const std::uint64_t seed = mixed_seed(seed_of_all ^ shared_stream, packet[0]);
  for (int q = 0; q < 4; ++q) frame.seeds[q] = static_cast<std::uint32_t>(mixed_seed(seed, q));
  return frame;
}

void GatherRays::trace(const PacketScene& scene, const GatherOperator::Packet& packet,
                       const PacketFrame& frame, int first, int count, std::uint32_t* met) const {
  PacketScene asking = scene;
  const bool closed = std::any_of(packet.begin(), packet.end(),
                                  [&](int patch) { return patch >= 0 && enclosures_[patch] >= 0; });
  std::vector<DoubtfulRay> doubtful;
  Certainty certainty;
  for (int q = 0; q < count; q += rays_a_doubt) {
    std::uint32_t* ends = met + static_cast<std::size_t>(q) * lanes;
    doubtful.clear();
    asking.doubt_lost = closed || !certainty.enough();
    trace_packet(asking, frame, first + q, std::min(rays_a_doubt, count - q), ends, doubtful);
    if (!doubtful.empty()) settle(packet, first + q, doubtful, ends, certainty);
  }
}

bool GatherRays::Certainty::enough() const {
  return lost >= lost_for_certain && lost > wrong_among * found;
}

void GatherRays::trace(std::size_t packet, int first, int count, std::uint32_t* met) const {
  trace(scene_, packets_[packet], frame_of(packets_[packet], seed_), first, count, met);
}

int GatherRays::rays_together() const {
  return together_ == 1 ? rays_a_visit : sorted_rays;
}

void GatherRays::aim(std::size_t first_packet, std::size_t packets, std::vector<PacketFrame>& frames) const {
  frames.resize(packets);
  for (std::size_t p = 0; p < packets; ++p) frames[p] = frame_of(packets_[first_packet + p], seed_);
}

void GatherRays::trace_together(std::size_t first_packet, std::span<const PacketFrame> frames, int first,
                                int count, std::uint32_t* met, PatchRows rows) const {
  PacketScene scene = scene_;
  // of rays that are sorted first, the rows are read much later
  if (together_ == 1) scene.rows = rows;
  const std::size_t of_packet = static_cast<std::size_t>(count) * lanes;
  if (together_ == 1) {
    for (std::size_t p = 0; p < frames.size(); ++p) {
      trace(scene, packets_[first_packet + p], frames[p], first, count, met + p * of_packet);
    }
    return;
  }
  static thread_local SortedRays sorted;
  trace_sorted(scene, frames, first, count, met, sorted);
  std::stable_sort(sorted.doubtful.begin(), sorted.doubtful.end(),
                   [](const DoubtfulRay& a, const DoubtfulRay& b) {
                     return std::pair(a.ray, a.lane) < std::pair(b.ray, b.lane);
                   });
  for (auto from = sorted.doubtful.begin(); from != sorted.doubtful.end();) {
    const int packet = from->ray / count;
    std::vector<DoubtfulRay> of_one;
    for (; from != sorted.doubtful.end() && from->ray / count == packet; ++from) {
      of_one.push_back(*from);
      of_one.back().ray -= packet * count;
    }
    Certainty certainty;
    settle(packets_[first_packet + packet], first, of_one, met + packet * of_packet, certainty);
  }
}

void GatherRays::trace_sample(std::size_t packet, int sample, int count, std::uint32_t* met) const {
  const PacketFrame frame = frame_of(packets_[packet], mixed_seed(seed_ ^ sample_stream, sample));
  trace(scene_, packets_[packet], frame, 0, count, met);
}

bool GatherRays::set_count(int count) {
  count_ = count;
  words_ = net_words(std::max(count, most_rays_sampled));
  scene_.words = words_.data();
  const std::uint32_t digits = lower_digits_;
  lower_digits_ = map_.triangles().size() > large_scene ? 0 : 0xffffffffu >> shared_digits(count);
  return lower_digits_ == digits;
}

void GatherRays::trace_patch(int patch, const PatchNet& net, std::uint64_t seed, std::uint32_t* met) const {
  GatherOperator::Packet packet;
  packet.fill(patch);
  PacketFrame frame = frame_of(packet, seed_);
  const std::uint64_t own = mixed_seed(seed ^ single_stream, patch);
  for (int q = 0; q < 4; ++q) {
    frame.seeds[q] = static_cast<std::uint32_t>(mixed_seed(own, q));
    std::fill_n(frame.turned[q], lanes, 0u);
  }
  PacketScene scene = scene_;
  scene.words = net.words_.data();
  scene.lane_words = true;
  trace(scene, packet, frame, 0, net.blocks_, met);
}

void GatherRays::settle(const GatherOperator::Packet& packet, int first,
                        std::span<const DoubtfulRay> doubtful, std::uint32_t* met,
                        Certainty& certainty) const {
  int asked = 0;
  for (const DoubtfulRay& ray : doubtful) {
    const int patch = packet[ray.lane];
    const bool closed = enclosures_[patch] >= 0;
    if (ray.lost && !closed && certainty.enough()) continue;
    std::uint32_t& end = met[static_cast<std::size_t>(ray.ray) * lanes + ray.lane];
    end = settled(patch, ray);
    ++asked;
    if (ray.lost) ++(end == static_cast<std::uint32_t>(mesh_.size()) ? certainty.lost : certainty.found);
    if (closed && end == static_cast<std::uint32_t>(mesh_.size())) {
      end = replaced(patch, mixed_seed(seed_ ^ replacement_stream, first + ray.ray));
    }
  }
  asked_twice_ += asked;
}

/// The patch that a ray meets, in double precision; -1 for nothing, or in a closed enclosure for a patch of
/// another.
int GatherRays::patch_met(int patch, const Vec3& origin, const Vec3& direction) const {
  RayScene::Hit hit;
  occluders_.intersect({&origin, 1}, {&mesh_.normals[patch], 1}, {&direction, 1}, {&hit, 1});
  if (hit.primitive < 0) return -1;
  const int met = locator().patch_at(hit.primitive, hit.front, origin + hit.distance * direction);
  if (met < 0) return -1;
  const bool leaked = enclosures_[patch] >= 0 && enclosures_[met] != enclosures_[patch];
  return leaked ? -1 : met;
}

/// The patch at a hit whose texel does not know; -1 as in patch_met().
int GatherRays::patch_hit(int patch, const DoubtfulRay& ray) const {
  const auto& [a, b, c] = mesh_.occluders.triangles[ray.triangle];
  const Vec3& corner = mesh_.occluders.vertices[a];
  const Vec3 point = corner + ray.u * (mesh_.occluders.vertices[b] - corner) +
                     ray.v * (mesh_.occluders.vertices[c] - corner);
  const int met = locator().patch_at(ray.triangle, ray.front, point);
  if (met < 0) return -1;
  return enclosures_[patch] >= 0 && enclosures_[met] != enclosures_[patch] ? -1 : met;
}

std::uint32_t GatherRays::settled(int patch, const DoubtfulRay& ray) const {
  int met = ray.lost ? -1 : patch_hit(patch, ray);
  if (met < 0) {
    const auto vector = [](const float* x) { return Vec3(x[0], x[1], x[2]); };
    Vec3 origin = vector(ray.origin) / occluders_.scale() + occluders_.centre();
    const Vec3& normal = mesh_.normals[patch];
    origin -= normal.dot(origin - mesh_.centroids[patch]) * normal;
    met = patch_met(patch, origin, vector(ray.direction).normalized());
  }
  return static_cast<std::uint32_t>(met >= 0 ? met : mesh_.size());
}

/// What some other ray of the patch meets.
std::uint32_t GatherRays::replaced(int patch, std::uint64_t seed) const {
  const HemisphereRays rays =
      hemisphere_rays(mesh_, patch, replacements, mixed_seed(seed, patch), outline_margin(occluders_));
  for (int k = 0; k < replacements; ++k) {
    const int met = patch_met(patch, rays.origins[k], rays.directions[k]);
    if (met >= 0) return static_cast<std::uint32_t>(met);
  }
  return static_cast<std::uint32_t>(mesh_.size());
}

}  // namespace luxel
