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

  /// Another number of rays from each patch. Tells whether what was traced so far still belongs to the same
  /// nets; else trace() gives others from now on.
  bool set_count(int count);

  std::span<const GatherOperator::Packet> packets() const { return packets_; }
  int count() const { return count_; }
  std::size_t bytes() const;

  /// What rays first .. first + count of a packet meet, count x lanes patches, or mesh.size() for nothing.
  /// Idle lanes hold any of these.
  void trace(std::size_t packet, int first, int count, std::uint32_t* met) const;

  /// What the first rays of a packet's other nets meet: `sample` numbers nets that are independent of those
  /// of trace(), with as many shared digits.
  void trace_sample(std::size_t packet, int sample, int count, std::uint32_t* met) const;

  /// Packets that are best traced in one go: 1 where a packet's rays keep together by themselves, many in
  /// large scenes of small polygons, whose rays are sorted first. Multiples of it share out the packets.
  std::size_t packets_together() const { return together_; }
  /// Rays of a packet that are best traced in one go.
  int rays_together() const;
  /// Where the rays of packets first_packet .. first_packet + packets start, for all goes at them.
  void aim(std::size_t first_packet, std::size_t packets, std::vector<PacketFrame>& frames) const;
  /// trace() for the packets of these frames. The rows of patches met are called into the cache.
  void trace_together(std::size_t first_packet, std::span<const PacketFrame> frames, int first, int count,
                      std::uint32_t* met, PatchRows rows = {}) const;

  /// Rays settled in double precision so far.
  std::int64_t asked_twice() const { return asked_twice_; }

 private:
  void call_for(const GatherOperator::Packet& packet) const;
  PacketFrame frame_of(const GatherOperator::Packet& packet, std::uint64_t seed) const;
  void trace(const PacketScene& scene, const GatherOperator::Packet& packet, const PacketFrame& frame,
             int first, int count, std::uint32_t* met) const;
  /// Of a packet's lost rays: those that were asked again and are lost, and those that are not.
  struct Certainty {
    int lost = 0, found = 0;
    bool enough() const;
  };
  /// Puts right what `doubtful` says of rays first .. of a packet.
  void settle(const GatherOperator::Packet& packet, int first, std::span<const DoubtfulRay> doubtful,
              std::uint32_t* met, Certainty& certainty) const;
  int patch_hit(int patch, const DoubtfulRay& ray) const;
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
  std::uint32_t lower_digits_ = 0;  // of a direction: those that are a patch's own
  std::size_t together_ = 1;
  std::vector<std::int32_t> enclosures_;  // the closed cell of each patch or -1; and of nothing
  PacketScene scene_;
  mutable std::once_flag locator_made_;
  mutable std::unique_ptr<PatchLocator> locator_;
  mutable std::atomic<std::int64_t> asked_twice_ = 0;
};

}  // namespace luxel
