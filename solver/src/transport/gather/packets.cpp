#include "transport/gather/packets.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// A polygon's side with fewer patches fills no packet of its own: half of one's lanes would idle.
constexpr std::size_t least_of_one_polygon = lanes / 2;

using Keyed = std::pair<std::uint64_t, int>;  // place on the curve, patch

std::uint64_t spread_by_three(std::uint64_t x) {  // 20 bits to every third
  x &= 0xfffff;
  x = (x | x << 32) & 0x001f00000000ffffu;
  x = (x | x << 16) & 0x001f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  x = (x | x << 2) & 0x1249249249249249u;
  return x;
}

/// Morton's curve over the box of all centroids, 2^20 steps a side.
class Curve {
 public:
  explicit Curve(const PatchMesh& mesh) {
    low_ = mesh.centroids[0];
    Vec3 high = low_;
    for (const Vec3& x : mesh.centroids) {
      low_ = low_.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const double extent = (high - low_).maxCoeff();
    steps_ = extent > 0 ? 0xfffff / extent : 0;
  }
  std::uint64_t operator()(const Vec3& x) const {
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      key |= spread_by_three(static_cast<std::uint64_t>((x[k] - low_[k]) * steps_)) << k;
    }
    return key;
  }

 private:
  Vec3 low_;
  double steps_;
};

/// The side of a cube that a normal points to, 0 to 5.
int facing(const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (normal[axis] < 0);
}

void add_packets(std::span<const Keyed> patches, std::vector<GatherOperator::Packet>& packets) {
  const std::size_t count = (patches.size() + lanes - 1) / lanes;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t begin = patches.size() * p / count, end = patches.size() * (p + 1) / count;
    GatherOperator::Packet packet;
    packet.fill(-1);
    for (std::size_t k = begin; k < end; ++k) packet[k - begin] = patches[k].second;
    packets.push_back(packet);
  }
}

}  // namespace

int used_lanes(const GatherOperator::Packet& packet) {
  return static_cast<int>(std::find(packet.begin(), packet.end(), -1) - packet.begin());
}

std::vector<GatherOperator::Packet> packets_of(const PatchMesh& mesh) {
  std::vector<GatherOperator::Packet> packets;
  if (mesh.size() == 0) return packets;
  const Curve curve(mesh);

  // a polygon's sides are told apart by the facing of its first patch
  std::vector<int> first(mesh.occluders.polygon_count, -1);
  std::vector<int> starts(2 * first.size() + 1, 0);
  std::vector<int> side_of(mesh.size());
  for (int i = 0; i < mesh.size(); ++i) {
    int& model = first[mesh.polygons[i]];
    if (model < 0) model = i;
    side_of[i] = 2 * mesh.polygons[i] + (mesh.normals[i].dot(mesh.normals[model]) < 0);
    ++starts[side_of[i] + 1];
  }
  for (std::size_t s = 1; s < starts.size(); ++s) starts[s] += starts[s - 1];
  std::vector<Keyed> by_side(mesh.size());
  std::vector<int> next(starts.begin(), starts.end() - 1);
  for (int i = 0; i < mesh.size(); ++i) by_side[next[side_of[i]]++] = {curve(mesh.centroids[i]), i};

  std::vector<Keyed> rest;
  for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
    const std::span<Keyed> side(by_side.data() + starts[s], by_side.data() + starts[s + 1]);
    if (side.size() < least_of_one_polygon) {
      rest.insert(rest.end(), side.begin(), side.end());
    } else {
      tbb::parallel_sort(side.begin(), side.end());
      add_packets(side, packets);
    }
  }
  std::vector<std::vector<Keyed>> facings(6);
  for (const Keyed& patch : rest) facings[facing(mesh.normals[patch.second])].push_back(patch);
  for (std::vector<Keyed>& patches : facings) {
    tbb::parallel_sort(patches.begin(), patches.end());
    add_packets(patches, packets);
  }
  return packets;
}

}  // namespace luxel
