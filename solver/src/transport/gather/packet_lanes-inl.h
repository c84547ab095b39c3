// How from the hits of sixteen rays the patches are found. Included once per target, see Highway's
// foreach_target.h: hence no pragma once.
#if defined(LUXEL_PACKET_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LUXEL_PACKET_LANES_INL_H
#undef LUXEL_PACKET_LANES_INL_H
#else
#define LUXEL_PACKET_LANES_INL_H
#endif

#include <embree3/rtcore.h>
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <limits>

#include "transport/gather/packet_kernel.h"
#include "transport/gather/packet_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {

// A whole packet as if it had met nothing yet.
HWY_INLINE void ResetHits(RTCRayHit16& rays) {
  const Real d;
  const Word w;
  for (size_t k = 0; k < lanes; k += hn::Lanes(d)) {
    hn::Store(hn::Zero(d), d, rays.ray.tnear + k);
    hn::Store(hn::Set(d, std::numeric_limits<float>::infinity()), d, rays.ray.tfar + k);
    hn::Store(hn::Set(w, RTC_INVALID_GEOMETRY_ID), w, rays.hit.geomID + k);
  }
}

// A packet under way, and where its hits lie in the map.
struct alignas(64) Flight {
  RTCRayHit16 rays = {};
  int32_t texels[lanes];
};

// Four numbers of each lane's row, transposed: `rows` of 8 words, from lane k on.
struct Columns {
  Reals c0, c1, c2, c3;
};

#if HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR

HWY_INLINE Columns FourColumns(const float* rows, const int32_t* row, int from) {
  const Real d;
  const Number n;
  const Numbers at = hn::Add(hn::ShiftLeft<3>(hn::Load(n, row)), hn::Set(n, from));
  const auto column = [&](int q) { return hn::GatherIndex(d, rows, hn::Add(at, hn::Set(n, q))); };
  return {column(0), column(1), column(2), column(3)};
}

#else

// Rows of four lanes apart, a block of 128 bits each.
template <class Tag>
HWY_INLINE hn::Vec<Tag> Blocks(Tag d, const float* rows, const int32_t* row) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Load(d, rows + 8 * static_cast<ptrdiff_t>(row[0]));
  } else {
    const hn::Half<Tag> half;
    return hn::Combine(d, Blocks(half, rows, row + hn::MaxLanes(half)), Blocks(half, rows, row));
  }
}

// By loads of whole rows: some eight gathers' worth of time less than by gathers.
HWY_INLINE Columns FourColumns(const float* rows, const int32_t* row, int from) {
  const Real d;
  rows += from;
  const Reals r0 = Blocks(d, rows, row), r1 = Blocks(d, rows, row + 1), r2 = Blocks(d, rows, row + 2),
              r3 = Blocks(d, rows, row + 3);
  const Reals even_low = hn::InterleaveLower(d, r0, r2), even_high = hn::InterleaveUpper(d, r0, r2);
  const Reals odd_low = hn::InterleaveLower(d, r1, r3), odd_high = hn::InterleaveUpper(d, r1, r3);
  return {hn::InterleaveLower(d, even_low, odd_low), hn::InterleaveUpper(d, even_low, odd_low),
          hn::InterleaveLower(d, even_high, odd_high), hn::InterleaveUpper(d, even_high, odd_high)};
}

#endif

// Where lanes k .. hit; their texels are called for.
HWY_INLINE void FindTexels(const PacketScene& scene, int k, Flight& flight) {
  const Real d;
  const Word w;
  const Number n;
  const RTCHit16& hits = flight.rays.hit;
  const RTCRay16& rays = flight.rays.ray;
  const auto hit =
      hn::RebindMask(n, hn::Ne(hn::Load(w, hits.geomID + k), hn::Set(w, RTC_INVALID_GEOMETRY_ID)));
  // a lane without a hit holds no triangle
  alignas(64) int32_t triangle[lanes];
  hn::Store(hn::IfThenElseZero(hit, hn::BitCast(n, hn::Load(w, hits.primID + k))), n, triangle);
  const auto* rows = reinterpret_cast<const float*>(scene.map->triangles().data());
  const Columns one = FourColumns(rows, triangle, 0), two = FourColumns(rows, triangle, 4);

  const Reals u = hn::Load(d, hits.u + k), v = hn::Load(d, hits.v + k);
  const Reals x = hn::MulAdd(u, one.c1, hn::MulAdd(v, one.c2, one.c0));
  const Reals y = hn::MulAdd(u, two.c0, hn::MulAdd(v, two.c1, one.c3));
  const Words size = hn::BitCast(w, two.c2), largest = hn::Set(w, HitMap::largest_size);
  const Numbers width = hn::BitCast(n, hn::And(size, largest));
  const Numbers height = hn::BitCast(n, hn::And(hn::ShiftRight<HitMap::size_bits>(size), largest));
  // rounded towards 0: a hair outside is inside again
  const Numbers last = hn::Set(n, -1);
  const Numbers column = hn::Min(hn::Add(width, last), hn::ConvertTo(n, x));
  const Numbers row = hn::Min(hn::Add(height, last), hn::ConvertTo(n, y));

  // Embree's normal points to where the corners run counter-clockwise: the front
  const Reals facing =
      hn::MulAdd(hn::Load(d, hits.Ng_x + k), hn::Load(d, rays.dir_x + k),
                 hn::MulAdd(hn::Load(d, hits.Ng_y + k), hn::Load(d, rays.dir_y + k),
                            hn::Mul(hn::Load(d, hits.Ng_z + k), hn::Load(d, rays.dir_z + k))));
  const auto back = hn::RebindMask(n, hn::Ge(facing, hn::Zero(d)));
  // the flag of the front one from the left, that of the back leftmost
  const Numbers flags = hn::BitCast(n, size), front = hn::ShiftLeft<1>(flags);
  const auto on_patch = hn::And(hit, hn::Lt(hn::IfThenElse(back, flags, front), hn::Zero(n)));
  const auto behind = hn::And(back, hn::Lt(front, hn::Zero(n)));
  const Numbers line = hn::Add(row, hn::IfThenElseZero(behind, height));
  const Numbers texel = hn::Add(hn::BitCast(n, two.c3), hn::Add(hn::Mul(line, width), column));
  hn::Store(hn::IfThenElse(on_patch, texel, hn::Set(n, scene.map->nothing())), n, flight.texels + k);
  const int end = k + static_cast<int>(hn::Lanes(n));
  for (int q = k; q < end; ++q) hwy::Prefetch(scene.map->texels().data() + flight.texels[q]);
}

// The patches there to `met`; gives the lanes in doubt.
HWY_INLINE uint64_t FindPatches(const PacketScene& scene, const int32_t* enclosure, const int32_t* valid,
                                const Flight& flight, int k, uint32_t* met) {
  const Word w;
  const Number n;
  const Words nothing = hn::Set(w, static_cast<uint32_t>(scene.nothing));
  // one by one: a vector gather waits for the slowest before it asks for the next
  const int32_t* texels = scene.map->texels().data();
  alignas(64) int32_t patches[lanes];
  for (size_t q = 0; q < hn::Lanes(n); ++q) patches[q] = texels[flight.texels[k + q]];
  const Words patch = hn::BitCast(w, hn::Load(n, patches));
  // HitMap::ask is beyond all numbers
  const Words known = hn::Min(patch, nothing);
  auto doubtful = hn::RebindMask(n, scene.doubt_lost ? hn::Eq(known, nothing) : hn::Gt(patch, nothing));
  if (scene.enclosures) {
    const Numbers home = hn::Load(n, enclosure + k);
    const auto elsewhere = hn::Ne(hn::GatherIndex(n, scene.enclosures, hn::BitCast(n, known)), home);
    doubtful = hn::Or(doubtful, hn::AndNot(hn::Lt(home, hn::Zero(n)), elsewhere));
  }
  hn::StoreU(known, w, met + k);
  if (scene.rows.first) {
    for (size_t q = 0; q < hn::Lanes(n); ++q) hwy::Prefetch(scene.rows.first + scene.rows.bytes * met[k + q]);
  }
  if (hn::AllFalse(n, doubtful)) return 0;
  doubtful = hn::And(doubtful, hn::Ne(hn::Load(n, valid + k), hn::Zero(n)));
  uint8_t bits[8] = {};
  hn::StoreMaskBits(n, doubtful, bits);
  return bits[0] | static_cast<uint64_t>(bits[1]) << 8;
}

HWY_INLINE DoubtfulRay Doubt(const PacketScene& scene, const Flight& flight, int k, int ray, int lane) {
  const RTCRay16& rays = flight.rays.ray;
  const RTCHit16& hits = flight.rays.hit;
  const bool asks = scene.map->texels()[flight.texels[k]] == HitMap::ask;
  const float facing =
      hits.Ng_x[k] * rays.dir_x[k] + hits.Ng_y[k] * rays.dir_y[k] + hits.Ng_z[k] * rays.dir_z[k];
  return {ray,
          lane,
          !asks,
          {rays.org_x[k], rays.org_y[k], rays.org_z[k]},
          {rays.dir_x[k], rays.dir_y[k], rays.dir_z[k]},
          static_cast<int>(hits.primID[k]),
          hits.u[k],
          hits.v[k],
          facing < 0};
}

HWY_INLINE void Land(const PacketScene& scene, const PacketFrame& frame, const Flight& flight, int ray,
                     uint32_t* met, std::vector<DoubtfulRay>& doubtful) {
  const int step = static_cast<int>(hn::Lanes(Real()));
  uint64_t doubts = 0;
  for (int k = 0; k < lanes; k += step) {
    doubts |=
        FindPatches(scene, frame.enclosure, frame.valid, flight, k, met + static_cast<size_t>(ray) * lanes)
        << k;
  }
  for (; doubts != 0; doubts &= doubts - 1) {
    const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(doubts));
    doubtful.push_back(Doubt(scene, flight, k, ray, k));
  }
}

}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
