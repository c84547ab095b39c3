#include "transport/gather/packet_kernel.h"

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
  const LaineKarras scramble;
  const int words_a_ray = scene.lane_words ? 4 * lanes : 4;
  for (int q = 0; q < count; ++q) {
    Flight& flight = flights[q % 2];
    const uint32_t* words = scene.words + words_a_ray * static_cast<size_t>(first + q);
    const uint32_t height = bits_reversed(scramble(words[2], frame.shared_seeds[0]));
    const uint32_t azimuth = bits_reversed(scramble(words[3], frame.shared_seeds[1]));
    RTCRay16& ray = flight.rays.ray;
    float* const origins[3] = {ray.org_x, ray.org_y, ray.org_z};
    float* const directions[3] = {ray.dir_x, ray.dir_y, ray.dir_z};
    for (int k = 0; k < lanes; k += step) {
      StartRays(scene, frame, words, height, azimuth, k, origins, directions);
    }
    ResetHits(flight.rays);
    rtcIntersect16(frame.valid, static_cast<RTCScene>(scene.embree), &context, &flight.rays);
    for (int k = 0; k < lanes; k += step) FindTexels(scene, k, flight);
    if (q > 0) Land(scene, frame, flights[(q - 1) % 2], q - 1, met, doubtful);
  }
  if (count > 0) Land(scene, frame, flights[(count - 1) % 2], count - 1, met, doubtful);
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

}  // namespace luxel
#endif
