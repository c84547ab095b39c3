#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "luxel/gather_operator.h"
#include "patch_locator.h"
#include "transport/gather/hit_map.h"
#include "transport/gather/packet_kernel.h"

namespace luxel {

/// The rays of a gather: for each packet of patches the first `count` points of one scrambled net, traced in
/// any number of goes. Safe from many threads. The mesh and the ray scene must outlive it.
///
/// Where the surfaces prove that patches look into a closed cell, no ray of theirs is lost and none leaves
/// the cell. Elsewhere a lost ray is asked again in double precision, until it is clear that the packet's
/// rays do get lost.
class GatherRays {
 public:
  /// @param count  rays from each patch in all; the net's digits that a packet shares follow from it
  GatherRays(const PatchMesh& mesh, const RayScene& occluders, int count, std::uint64_t seed);

  std::span<const GatherOperator::Packet> packets() const { return packets_; }
  int count() const { return count_; }
  std::size_t bytes() const;

  /// What rays first .. first + count of a packet meet, count x lanes patches, or mesh.size() for nothing.
  /// Idle lanes hold any of these.
  void trace(std::size_t packet, int first, int count, std::uint32_t* met) const;

  /// Rays settled in double precision so far.
  std::int64_t asked_twice() const { return asked_twice_; }

 private:
  PacketFrame frame_of(const GatherOperator::Packet& packet) const;
  std::uint32_t settled(int patch, const DoubtfulRay& ray) const;
  std::uint32_t replaced(int patch, std::uint64_t seed) const;
  int patch_met(int patch, const Vec3& origin, const Vec3& direction) const;
  const PatchLocator& locator() const;

  const PatchMesh& mesh_;
  const RayScene& occluders_;
  int count_;
  std::uint64_t seed_;
  std::vector<GatherOperator::Packet> packets_;
  HitMap map_;
  std::vector<std::uint32_t> words_;
  std::vector<std::int32_t> enclosures_;  // the closed cell of each patch or -1; and of nothing
  PacketScene scene_;
  mutable std::once_flag locator_made_;
  mutable std::unique_ptr<PatchLocator> locator_;
  mutable std::atomic<std::int64_t> asked_twice_ = 0;
};

}  // namespace luxel
