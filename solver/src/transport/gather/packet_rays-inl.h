// How sixteen rays are made. Included once per target, see Highway's
// foreach_target.h: hence no pragma once.
#if defined(LUXEL_PACKET_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LUXEL_PACKET_RAYS_INL_H
#undef LUXEL_PACKET_RAYS_INL_H
#else
#define LUXEL_PACKET_RAYS_INL_H
#endif

#include <hwy/highway.h>

#include <cmath>

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

// Where lanes start, and which way: all with one point of the net.
HWY_INLINE void StartRays(const NetPoints& points, int point, const PacketFrame& frame,
                          float* const origins[3], float* const directions[3]) {
  const Real d;
  const Word w;
  for (size_t lane = 0; lane < lanes; lane += hn::Lanes(w)) {
    const int k = static_cast<int>(lane);
    const auto number = [&](int q) {
      return Fraction(hn::Xor(hn::Set(w, points.rows[q][point]), hn::Load(w, frame.turned[q] + k)));
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

}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
