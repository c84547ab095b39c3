#include "transport/gather/gather_rays.h"

#include <hwy/cache_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "enclosures/cells.h"
#include "enclosures/shells.h"
#include "enclosures/triangle_soup.h"
#include "sampling/owen_sobol.h"
#include "transport/gather/packets.h"
#include "transport/gather/patch_frame.h"
#include "transport/gather/sorted_rays.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Streams of random numbers, all seeded by patch or packet.
constexpr std::uint64_t own_stream = 0x67617468, shared_stream = 0x73686172, sample_stream = 0x73616d70;

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

GatherRays::GatherRays(const PatchMesh& mesh, const RayScene& occluders, int count, std::uint64_t seed)
    : mesh_(mesh),
      occluders_(occluders),
      seed_(seed),
      packets_(packets_of(mesh)),
      map_(mesh, HitMap::texels_for(mesh.size(), count)),
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

}  // namespace luxel
