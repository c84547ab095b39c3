#include "transport/gather/packet_kernel.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "sampling/sobol_words.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/gather/packet_kernel.cpp"
// Highway compiles this file once per instruction set; the order of its headers matters.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Real = hn::CappedTag<float, PacketFrame::lanes>;
using Word = hn::RebindToUnsigned<Real>;
using Number = hn::RebindToSigned<Real>;
using Reals = hn::Vec<Real>;
using Words = hn::Vec<Word>;
using Numbers = hn::Vec<Number>;

constexpr int lanes = PacketFrame::lanes;

HWY_INLINE Words Scrambled(const Words word, const Words seed) {
  const Word d;
  Words x = word;
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, LaineKarras::first)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), hn::Set(d, 1u)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, LaineKarras::second)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, LaineKarras::third)));
  return x;
}

// Bits of a byte by two tables of half bytes, then the bytes of a word.
HWY_INLINE Words BitsReversed(const Words word) {
  const hn::Repartition<uint8_t, Word> d;
  alignas(16) static constexpr uint8_t lower[16] = {0x00, 0x80, 0x40, 0xc0, 0x20, 0xa0, 0x60, 0xe0,
                                                    0x10, 0x90, 0x50, 0xd0, 0x30, 0xb0, 0x70, 0xf0};
  alignas(16) static constexpr uint8_t upper[16] = {0x0, 0x8, 0x4, 0xc, 0x2, 0xa, 0x6, 0xe,
                                                    0x1, 0x9, 0x5, 0xd, 0x3, 0xb, 0x7, 0xf};
  alignas(16) static constexpr uint8_t bytes[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  const Word w;
  const Words mask = hn::Set(w, 0x0f0f0f0fu);
  const auto low = hn::BitCast(d, hn::And(word, mask));
  const auto high = hn::BitCast(d, hn::And(hn::ShiftRight<4>(word), mask));
  const auto turned = hn::Or(hn::TableLookupBytes(hn::LoadDup128(d, lower), low),
                             hn::TableLookupBytes(hn::LoadDup128(d, upper), high));
  return hn::BitCast(w, hn::TableLookupBytes(turned, hn::LoadDup128(d, bytes)));
}

// 24 bits as a fraction in [0, 1).
HWY_INLINE Reals Fraction(const Words word) {
  const Real d;
  const Number n;
  return hn::Mul(hn::ConvertTo(d, hn::BitCast(n, hn::ShiftRight<8>(word))), hn::Set(d, 0x1p-24f));
}

struct Direction {
  Reals x, y, z;
};

// Cosine-distributed about z (Malley). The azimuth t in [0, 1) by sine and cosine of pi (t - 1/2), Taylor to
// 4e-6, and the double angle.
HWY_INLINE Direction CosineDirection(const Reals height, const Reals azimuth) {
  const Real d;
  // half a step up from the horizon, which no ray may run along
  const Reals square = hn::Min(height, hn::Set(d, 1 - 0x1p-24f));
  const Reals radius = hn::Sqrt(square);
  const Reals half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  const Reals t = hn::Mul(hn::Sub(azimuth, half), hn::Set(d, 3.14159265f));
  const Reals t2 = hn::Mul(t, t);
  Reals sine = hn::MulAdd(t2, hn::Set(d, 2.7557319e-6f), hn::Set(d, -1.9841270e-4f));
  sine = hn::MulAdd(t2, sine, hn::Set(d, 8.3333333e-3f));
  sine = hn::MulAdd(t2, sine, hn::Set(d, -1.6666667e-1f));
  sine = hn::Mul(t, hn::MulAdd(t2, sine, one));
  Reals cosine = hn::MulAdd(t2, hn::Set(d, -2.7557319e-7f), hn::Set(d, 2.4801587e-5f));
  cosine = hn::MulAdd(t2, cosine, hn::Set(d, -1.3888889e-3f));
  cosine = hn::MulAdd(t2, cosine, hn::Set(d, 4.1666667e-2f));
  cosine = hn::MulAdd(t2, cosine, hn::Set(d, -0.5f));
  cosine = hn::MulAdd(t2, cosine, one);
  return {hn::Mul(radius, hn::NegMulAdd(hn::Mul(sine, sine), two, one)),
          hn::Mul(radius, hn::Mul(two, hn::Mul(sine, cosine))), hn::Sqrt(hn::Sub(one, square))};
}

// Lanes k .. of the ray `words` belongs to.
HWY_INLINE void StartRays(const PacketScene& scene, const PacketFrame& frame, const uint32_t* words,
                          uint32_t height, uint32_t azimuth, int k, RTCRayHit16& rays) {
  const Real d;
  const Word w;
  const auto seed = [&](int q) { return hn::Load(w, frame.seeds[q] + k); };
  const auto own = [&](int q) { return BitsReversed(Scrambled(hn::Set(w, words[q]), seed(q))); };

  // the point: which triangle, then the square folded to it
  Reals s = Fraction(own(0)), t = Fraction(own(1));
  const Reals share = hn::Load(d, frame.share + k), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const auto in_first = hn::Lt(s, share);
  s = hn::IfThenElse(in_first, hn::Div(s, share),
                     hn::Div(hn::Sub(s, share), hn::Max(hn::Sub(one, share), hn::Set(d, 0x1p-24f))));
  const auto above = hn::Gt(t, s);
  const Reals half_s = hn::Mul(s, half), half_t = hn::Mul(t, half);
  s = hn::IfThenElse(above, half_s, hn::Sub(s, half_t));
  t = hn::IfThenElse(above, hn::Sub(t, half_s), half_t);

  // the direction: upper digits from the packet, lower from the lane
  const Words lower = hn::Set(w, scene.lower_digits);
  const auto joined = [&](uint32_t shared, int q) {
    return Fraction(hn::Or(hn::Set(w, shared & ~scene.lower_digits), hn::And(own(q), lower)));
  };
  const Direction local = CosineDirection(joined(height, 2), joined(azimuth, 3));

  float* origins[3] = {rays.ray.org_x, rays.ray.org_y, rays.ray.org_z};
  float* directions[3] = {rays.ray.dir_x, rays.ray.dir_y, rays.ray.dir_z};
  for (int c = 0; c < 3; ++c) {
    const Reals second = hn::Load(d, frame.second[c] + k);
    const Reals a = hn::IfThenElse(in_first, hn::Load(d, frame.first[c] + k), second);
    const Reals b = hn::IfThenElse(in_first, second, hn::Load(d, frame.third[c] + k));
    hn::Store(hn::MulAdd(s, a, hn::MulAdd(t, b, hn::Load(d, frame.corner[c] + k))), d, origins[c] + k);
    const Reals along = hn::MulAdd(local.x, hn::Load(d, frame.tangent[c] + k),
                                   hn::MulAdd(local.y, hn::Load(d, frame.bitangent[c] + k),
                                              hn::Mul(local.z, hn::Load(d, frame.normal[c] + k))));
    hn::Store(along, d, directions[c] + k);
  }
  hn::Store(hn::Zero(d), d, rays.ray.tnear + k);
  hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, rays.ray.tfar + k);
  hn::Store(hn::Set(w, RTC_INVALID_GEOMETRY_ID), w, rays.hit.geomID + k);
}

// The patches met by lanes k .. to `met`; gives the lanes in doubt.
HWY_INLINE uint64_t FindPatches(const PacketScene& scene, const PacketFrame& frame, const RTCRayHit16& rays,
                                int k, uint32_t* met) {
  const Real d;
  const Word w;
  const Number n;
  const auto* numbers = reinterpret_cast<const int32_t*>(scene.map->triangles().data());
  const auto* reals = reinterpret_cast<const float*>(numbers);
  const auto hit = hn::Ne(hn::Load(w, rays.hit.geomID + k), hn::Set(w, RTC_INVALID_GEOMETRY_ID));
  const auto hit_number = hn::RebindMask(n, hit);
  const Numbers nothing = hn::Set(n, scene.nothing), zero = hn::Zero(n), one = hn::Set(n, 1);

  const Numbers triangle = hn::IfThenElseZero(hit_number, hn::BitCast(n, hn::Load(w, rays.hit.primID + k)));
  const Numbers at = hn::Mul(triangle, hn::Set(n, HitMap::words));
  const auto real = [&](int q) { return hn::GatherIndex(d, reals, hn::Add(at, hn::Set(n, q))); };
  const auto number = [&](const Numbers q) { return hn::GatherIndex(n, numbers, hn::Add(at, q)); };
  // a lane without a hit holds no coordinates
  const Reals u = hn::IfThenElseZero(hn::RebindMask(d, hit), hn::Load(d, rays.hit.u + k));
  const Reals v = hn::IfThenElseZero(hn::RebindMask(d, hit), hn::Load(d, rays.hit.v + k));
  const Reals x = hn::MulAdd(u, real(1), hn::MulAdd(v, real(2), real(0)));
  const Reals y = hn::MulAdd(u, real(4), hn::MulAdd(v, real(5), real(3)));
  const Numbers width = number(hn::Set(n, 6)), height = number(hn::Set(n, 7));
  const Numbers column = hn::Max(zero, hn::Min(hn::Sub(width, one), hn::ConvertTo(n, x)));
  const Numbers row = hn::Max(zero, hn::Min(hn::Sub(height, one), hn::ConvertTo(n, y)));

  // Embree's normal points to where the corners run counter-clockwise: the front
  const Reals facing =
      hn::MulAdd(hn::Load(d, rays.hit.Ng_x + k), hn::Load(d, rays.ray.dir_x + k),
                 hn::MulAdd(hn::Load(d, rays.hit.Ng_y + k), hn::Load(d, rays.ray.dir_y + k),
                            hn::Mul(hn::Load(d, rays.hit.Ng_z + k), hn::Load(d, rays.ray.dir_z + k))));
  const auto back = hn::RebindMask(n, hn::Ge(facing, hn::Zero(d)));
  const Numbers first = number(hn::IfThenElse(back, hn::Set(n, 9), hn::Set(n, 8)));
  const auto on_patch = hn::And(hit_number, hn::Gt(first, hn::Set(n, -1)));
  const Numbers texel = hn::IfThenElseZero(on_patch, hn::Add(first, hn::Add(hn::Mul(row, width), column)));
  const Numbers patch =
      hn::IfThenElse(on_patch, hn::GatherIndex(n, scene.map->texels().data(), texel), nothing);

  const Numbers home = hn::Load(n, frame.enclosure + k);
  const auto asks = hn::Lt(patch, zero);
  const auto lost = hn::Eq(patch, nothing);
  const auto closed = hn::Gt(home, hn::Set(n, -1));
  const auto near = hn::RebindMask(n, hn::Lt(hn::Load(d, rays.ray.tfar + k), hn::Set(d, scene.near_back)));
  auto doubtful = hn::Or(asks, hn::And(lost, hn::Or(closed, near)));
  const Numbers known = hn::IfThenElse(asks, nothing, patch);
  if (scene.enclosures) {
    const auto elsewhere = hn::Ne(hn::GatherIndex(n, scene.enclosures, known), home);
    doubtful = hn::Or(doubtful, hn::And(closed, elsewhere));
  }
  doubtful = hn::And(doubtful, hn::Ne(hn::Load(n, frame.valid + k), zero));
  hn::StoreU(hn::BitCast(w, known), w, met + k);
  if (hn::AllFalse(n, doubtful)) return 0;
  uint8_t bits[8] = {};
  hn::StoreMaskBits(n, doubtful, bits);
  return bits[0] | static_cast<uint64_t>(bits[1]) << 8;
}

void Trace(const PacketScene& scene, const PacketFrame& frame, int first, int count, uint32_t* met,
           std::vector<DoubtfulRay>& doubtful) {
  const Real d;
  const int step = static_cast<int>(hn::Lanes(d));
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) RTCRayHit16 rays = {};
  for (int k = 0; k < lanes; ++k) {
    rays.ray.mask[k] = ~0u;
    rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  const LaineKarras scramble;
  for (int q = 0; q < count; ++q) {
    const uint32_t* words = scene.words + 4 * static_cast<size_t>(first + q);
    const uint32_t height = bits_reversed(scramble(words[2], frame.shared_seeds[0]));
    const uint32_t azimuth = bits_reversed(scramble(words[3], frame.shared_seeds[1]));
    for (int k = 0; k < lanes; k += step) StartRays(scene, frame, words, height, azimuth, k, rays);
    rtcIntersect16(frame.valid, static_cast<RTCScene>(scene.embree), &context, &rays);
    uint64_t doubts = 0;
    for (int k = 0; k < lanes; k += step) {
      doubts |= FindPatches(scene, frame, rays, k, met + static_cast<size_t>(q) * lanes) << k;
    }
    for (; doubts != 0; doubts &= doubts - 1) {
      const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(doubts));
      doubtful.push_back({q,
                          k,
                          {rays.ray.org_x[k], rays.ray.org_y[k], rays.ray.org_z[k]},
                          {rays.ray.dir_x[k], rays.ray.dir_y[k], rays.ray.dir_z[k]}});
    }
  }
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
