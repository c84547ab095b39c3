#include "transport/gather/sorted_rays.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/gather/sorted_rays.cpp"
// Highway compiles this file once per instruction set; the order of its headers matters.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "transport/gather/packet_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {
namespace {

// Cells a side of the unfolded octahedron that rays are sorted by.
constexpr int direction_cells = 16;

// The cell of a direction on the octahedron unfolded to a square.
HWY_INLINE uint32_t DirectionCell(float x, float y, float z) {
  const float scale = 1 / (std::abs(x) + std::abs(y) + std::abs(z));
  float s = x * scale, t = y * scale;
  if (z < 0) {
    const float folded = (1 - std::abs(t)) * (s < 0 ? -1.0f : 1.0f);
    t = (1 - std::abs(s)) * (t < 0 ? -1.0f : 1.0f);
    s = folded;
  }
  constexpr float half = direction_cells / 2.0f;
  const auto cell = [&](float at) {
    return static_cast<uint32_t>(std::min(direction_cells - 1.0f, std::max(0.0f, (at + 1) * half)));
  };
  return cell(t) * direction_cells + cell(s);
}

void TraceSorted(const PacketScene& scene, const PacketFrame* frames, int packets, int first, int count,
                 uint32_t* met, SortedRays& sorted) {
  const int step = static_cast<int>(hn::Lanes(Real()));
  NetPoints points;
  const size_t all = static_cast<size_t>(packets) * count * lanes;
  sorted.resize(all);
  // all rays, packet by packet
  size_t at = 0;
  for (int p = 0; p < packets; ++p) {
    for (int q = 0; q < count; ++q, at += lanes) {
      const int point = (first + q) % lanes;
      if (q == 0 || point == 0) points.Scramble(scene.words, (first + q) / lanes, frames[p].seeds);
      float* const origins[3] = {&sorted.origins[0][at], &sorted.origins[1][at], &sorted.origins[2][at]};
      float* const directions[3] = {&sorted.directions[0][at], &sorted.directions[1][at],
                                    &sorted.directions[2][at]};
      StartRays(points, point, frames[p], origins, directions);
    }
  }
  // by direction, in each cell by place
  std::vector<uint32_t>& starts = sorted.starts;
  starts.assign(direction_cells * direction_cells + 1, 0);
  for (size_t r = 0; r < all; ++r) {
    const uint32_t cell =
        DirectionCell(sorted.directions[0][r], sorted.directions[1][r], sorted.directions[2][r]);
    sorted.cells[r] = static_cast<uint16_t>(cell);
    ++starts[cell + 1];
  }
  for (size_t c = 1; c < starts.size(); ++c) starts[c] += starts[c - 1];
  for (size_t r = 0; r < all; ++r) sorted.order[starts[sorted.cells[r]]++] = static_cast<uint32_t>(r);

  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  // through small triangles even these part: one by one they are a third faster than as a packet
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  Flight flight;
  alignas(64) int32_t valid[lanes], enclosure[lanes];
  alignas(64) uint32_t ends[lanes];
  for (int k = 0; k < lanes; ++k) {
    flight.rays.ray.mask[k] = ~0u;
    flight.rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  for (size_t begin = 0; begin < all; begin += lanes) {
    RTCRay16& ray = flight.rays.ray;
    for (int k = 0; k < lanes; ++k) {
      const uint32_t r = sorted.order[begin + k];
      ray.org_x[k] = sorted.origins[0][r];
      ray.org_y[k] = sorted.origins[1][r];
      ray.org_z[k] = sorted.origins[2][r];
      ray.dir_x[k] = sorted.directions[0][r];
      ray.dir_y[k] = sorted.directions[1][r];
      ray.dir_z[k] = sorted.directions[2][r];
      const PacketFrame& frame = frames[r / (static_cast<uint32_t>(count) * lanes)];
      valid[k] = frame.valid[r % lanes];
      enclosure[k] = frame.enclosure[r % lanes];
    }
    ResetHits(flight.rays);
    rtcIntersect16(valid, static_cast<RTCScene>(scene.embree), &context, &flight.rays);
    uint64_t doubts = 0;
    for (int k = 0; k < lanes; k += step) {
      FindTexels(scene, k, flight);
      doubts |= FindPatches(scene, enclosure, valid, flight, k, ends) << k;
    }
    for (int k = 0; k < lanes; ++k) met[sorted.order[begin + k]] = ends[k];
    for (; doubts != 0; doubts &= doubts - 1) {
      const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(doubts));
      const uint32_t r = sorted.order[begin + k];
      sorted.doubtful.push_back(
          Doubt(scene, flight, k, static_cast<int>(r / lanes), static_cast<int>(r % lanes)));
    }
  }
}

}  // namespace
}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(TraceSorted);

void SortedRays::resize(std::size_t count) {
  for (int c = 0; c < 3; ++c) {
    origins[c].resize(count);
    directions[c].resize(count);
  }
  cells.resize(count);
  order.resize(count);
  doubtful.clear();
}

void trace_sorted(const PacketScene& scene, std::span<const PacketFrame> frames, int first, int count,
                  std::uint32_t* met, SortedRays& sorted) {
  HWY_DYNAMIC_DISPATCH(TraceSorted)
  (scene, frames.data(), static_cast<int>(frames.size()), first, count, met, sorted);
}

}  // namespace luxel
#endif
