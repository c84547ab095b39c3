#include "transport/gather/packet_kernel.h"

#include "sampling/sobol_words.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/gather/packet_kernel.cpp"
// Highway compiles this file once per instruction set; the order of its headers matters.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include "transport/gather/packet_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {
namespace {

void Trace(const PacketScene& scene, const PacketFrame& frame, int first, int count, uint32_t* met,
           std::vector<DoubtfulRay>& doubtful) {
  const int step = static_cast<int>(hn::Lanes(Real()));
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  // two in turn: the texels of one packet arrive while the next is traced
  Flight flights[2];
  for (Flight& flight : flights) {
    for (int k = 0; k < lanes; ++k) {
      flight.rays.ray.mask[k] = ~0u;
      flight.rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  NetPoints points;
  for (int q = 0; q < count; ++q) {
    Flight& flight = flights[q % 2];
    Flight& last = flights[(q + 1) % 2];
    if (q >= 2) Land(scene, frame, flight, q - 2, met, doubtful);
    const int at = first + q;
    if (q == 0 || at % lanes == 0) points.Scramble(scene.words, at / lanes, frame.seeds);
    RTCRay16& ray = flight.rays.ray;
    float* const origins[3] = {ray.org_x, ray.org_y, ray.org_z};
    float* const directions[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
    StartRays(points, at % lanes, frame, origins, directions);
    ResetHits(flight.rays);
    if (q >= 1) {
      for (int k = 0; k < lanes; k += step) FindTexels(scene, k, last);
    }
    rtcIntersect16(frame.valid, static_cast<RTCScene>(scene.embree), &context, &flight.rays);
  }
  if (count == 0) return;
  Flight& last = flights[(count - 1) % 2];
  for (int k = 0; k < lanes; k += step) FindTexels(scene, k, last);
  if (count > 1) Land(scene, frame, flights[count % 2], count - 2, met, doubtful);
  Land(scene, frame, last, count - 1, met, doubtful);
}

}  // namespace
}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(Trace);

void trace_packet(const PacketScene& scene, const PacketFrame& frame, int first, int count,
                  std::uint32_t* met, std::vector<DoubtfulRay>& doubtful) {
  HWY_DYNAMIC_DISPATCH(Trace)(scene, frame, first, count, met, doubtful);
}

std::vector<std::uint32_t> net_words(int count) {
  constexpr int lanes = PacketFrame::lanes;
  const int blocks = (count + lanes - 1) / lanes;
  const std::vector<std::uint32_t> words = reversed_sobol_words(blocks * lanes);
  std::vector<std::uint32_t> rows(words.size());
  for (int b = 0; b < blocks; ++b) {
    for (int k = 0; k < lanes; ++k) {
      for (int q = 0; q < 4; ++q) rows[(4 * b + q) * lanes + k] = words[4 * (b * lanes + k) + q];
    }
  }
  return rows;
}

}  // namespace luxel
#endif
