// How sixteen rays are made, and from their hits the patches found. Included once per target, see Highway's
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

#include <cmath>
#include <limits>

#include "sampling/sobol_words.h"
#include "transport/gather/packet_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {

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

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Words BitsReversed(const Words word) {
  return hn::Set(Word(), bits_reversed(hn::GetLane(word)));
}

#else

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

#endif

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

// Sixteen points of a net under nested uniform scrambling, a row for each of their numbers.
struct alignas(64) NetPoints {
  uint32_t rows[4][lanes];

  HWY_INLINE void Scramble(const uint32_t* words, int block, const uint32_t seeds[4]) {
    const Word w;
    words += 4 * lanes * static_cast<size_t>(block);
    for (int q = 0; q < 4; ++q) {
      for (size_t k = 0; k < lanes; k += hn::Lanes(w)) {
        const Words scrambled = Scrambled(hn::LoadU(w, words + q * lanes + k), hn::Set(w, seeds[q]));
        hn::Store(BitsReversed(scrambled), w, rows[q] + k);
      }
    }
  }
};

struct Place {
  Reals s, t;
};

// The half of the square beyond its diagonal folded onto the other (Heitz 2019), which moves points the
// least.
HWY_INLINE Place Folded(const Reals s, const Reals t) {
  const Real d;
  const Reals half = hn::Set(d, 0.5f), half_s = hn::Mul(s, half), half_t = hn::Mul(t, half);
  const auto above = hn::Gt(t, s);
  return {hn::IfThenElse(above, half_s, hn::Sub(s, half_t)),
          hn::IfThenElse(above, hn::Sub(t, half_s), half_t)};
}

// Where lanes k .. start, with two numbers of theirs.
template <PacketFrame::Shape shape>
HWY_INLINE void StartPoints(const PacketFrame& frame, Reals s, Reals t, int k, float* const origins[3]) {
  const Real d;
  if constexpr (shape == PacketFrame::Shape::quads) {
    // which triangle, then how far along
    const Reals share = hn::Load(d, frame.share + k);
    const auto in_first = hn::Lt(s, share);
    s = hn::IfThenElse(in_first, hn::Mul(s, hn::Load(d, frame.first_scale + k)),
                       hn::Mul(hn::Sub(s, share), hn::Load(d, frame.other_scale + k)));
    const Place place = Folded(s, t);
    for (int c = 0; c < 3; ++c) {
      const Reals second = hn::Load(d, frame.second[c] + k);
      const Reals a = hn::IfThenElse(in_first, hn::Load(d, frame.first[c] + k), second);
      const Reals b = hn::IfThenElse(in_first, second, hn::Load(d, frame.third[c] + k));
      hn::StoreU(hn::MulAdd(place.s, a, hn::MulAdd(place.t, b, hn::Load(d, frame.corner[c] + k))), d,
                 origins[c] + k);
    }
  } else {
    constexpr bool whole = shape == PacketFrame::Shape::parallelograms;
    const Place place = whole ? Place{s, t} : Folded(s, t);
    for (int c = 0; c < 3; ++c) {
      const Reals along_t = hn::Load(d, (whole ? frame.third : frame.second)[c] + k);
      hn::StoreU(hn::MulAdd(place.s, hn::Load(d, frame.first[c] + k),
                            hn::MulAdd(place.t, along_t, hn::Load(d, frame.corner[c] + k))),
                 d, origins[c] + k);
    }
  }
}

// Where lanes start, and which way: all with one point of the net, or with `point` -1 each with one of its
// own.
HWY_INLINE void StartRays(const NetPoints& points, int point, const PacketFrame& frame,
                          float* const origins[3], float* const directions[3]) {
  const Real d;
  const Word w;
  for (size_t lane = 0; lane < lanes; lane += hn::Lanes(w)) {
    const int k = static_cast<int>(lane);
    const auto number = [&](int q) {
      const Words shared = point < 0 ? hn::Load(w, points.rows[q] + k) : hn::Set(w, points.rows[q][point]);
      return Fraction(hn::Xor(shared, hn::Load(w, frame.turned[q] + k)));
    };
    const Reals s = number(0), t = number(1);
    switch (frame.shape) {
      case PacketFrame::Shape::triangles:
        StartPoints<PacketFrame::Shape::triangles>(frame, s, t, k, origins);
        break;
      case PacketFrame::Shape::parallelograms:
        StartPoints<PacketFrame::Shape::parallelograms>(frame, s, t, k, origins);
        break;
      default:
        StartPoints<PacketFrame::Shape::quads>(frame, s, t, k, origins);
    }
    const Direction local = CosineDirection(number(2), number(3));
    for (int c = 0; c < 3; ++c) {
      const Reals along = hn::MulAdd(local.x, hn::Load(d, frame.tangent[c] + k),
                                     hn::MulAdd(local.y, hn::Load(d, frame.bitangent[c] + k),
                                                hn::Mul(local.z, hn::Load(d, frame.normal[c] + k))));
      hn::StoreU(along, d, directions[c] + k);
    }
  }
}

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
