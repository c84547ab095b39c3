// Arcs around hidden regions for as many eyes as a vector has lanes. Included once per target, see Highway's
// foreach_target.h: hence no pragma once.
#if defined(LUXEL_HIDDEN_ARCS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LUXEL_HIDDEN_ARCS_INL_H
#undef LUXEL_HIDDEN_ARCS_INL_H
#else
#define LUXEL_HIDDEN_ARCS_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cstddef>
#include <numbers>

#include "luxel/vector.h"

HWY_BEFORE_NAMESPACE();
namespace luxel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

struct Vec3s {
  V x, y, z;
};

HWY_INLINE Vec3s minus(const Vec3s& a, const Vec3s& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE V dot(const Vec3s& a, const Vec3s& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Vec3s cross(const Vec3s& a, const Vec3s& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE Vec3s broadcast(D d, const Vec3& v) {
  return {hn::Set(d, v.x()), hn::Set(d, v.y()), hn::Set(d, v.z())};
}

// A column of vectors in the workspace.
class Vectors {
 public:
  Vectors(double* memory, D d) : memory_(memory), d_(d), lanes_(hn::Lanes(d)) {}
  HWY_INLINE void set(std::size_t k, const Vec3s& v) const {
    double* at = memory_ + 3 * k * lanes_;
    hn::Store(v.x, d_, at);
    hn::Store(v.y, d_, at + lanes_);
    hn::Store(v.z, d_, at + 2 * lanes_);
  }
  HWY_INLINE Vec3s operator[](std::size_t k) const {
    const double* at = memory_ + 3 * k * lanes_;
    return {hn::Load(d_, at), hn::Load(d_, at + lanes_), hn::Load(d_, at + 2 * lanes_)};
  }

 private:
  double* memory_;
  D d_;
  std::size_t lanes_;
};

// A column of numbers in the workspace.
class Numbers {
 public:
  Numbers(double* memory, D d) : memory_(memory), d_(d), lanes_(hn::Lanes(d)) {}
  HWY_INLINE void set(std::size_t k, V v) const { hn::Store(v, d_, memory_ + k * lanes_); }
  HWY_INLINE V operator[](std::size_t k) const { return hn::Load(d_, memory_ + k * lanes_); }

 private:
  double* memory_;
  D d_;
  std::size_t lanes_;
};

// The part [low, high] of an edge, as shares of its length; empty where low >= high.
struct Interval {
  V low, high;
};

// Keeps of the interval where a number that runs linearly from g0 (at 0) to g1 (at 1) is not negative.
HWY_INLINE void keep_positive(D d, V g0, V g1, Interval& kept) {
  const V zero = hn::Zero(d);
  const auto out0 = hn::Lt(g0, zero), out1 = hn::Lt(g1, zero);
  const V crossing = hn::Div(g0, hn::Sub(g0, g1));
  kept.low = hn::IfThenElse(hn::AndNot(out1, out0), hn::Max(kept.low, crossing), kept.low);
  kept.high = hn::IfThenElse(hn::AndNot(out0, out1), hn::Min(kept.high, crossing), kept.high);
  kept.high = hn::IfThenElse(hn::And(out0, out1), hn::Set(d, -1.0), kept.high);
}

// An edge from `from` to `from + along` as seen from the eye, with the inward normal of its plane.
struct Arc {
  Vec3s from, along, inward;
  V square, slope, length, height;  // from^2, from . along, along^2, |inward|
  V weight;                         // normal . inward / |inward|
};

HWY_INLINE Arc arc(D d, const Vec3s& from, const Vec3s& to, const Vec3s& inward, const Vec3s& normal) {
  Arc a{from, minus(to, from), inward, {}, {}, {}, {}, {}};
  a.square = dot(a.from, a.from);
  a.slope = dot(a.from, a.along);
  a.length = dot(a.along, a.along);
  a.height = hn::Sqrt(hn::Max(dot(inward, inward), hn::Set(d, 1e-200)));
  a.weight = hn::Div(dot(normal, inward), a.height);
  return a;
}

// Angle under which the eye sees the part of the arc, times its weight; 0 where the part is empty.
HWY_INLINE V lambert(D d, const Arc& a, const Interval& part) {
  const V zero = hn::Zero(d);
  const auto some = hn::Gt(part.high, part.low);
  if (hn::AllFalse(d, some)) return zero;
  const V sine = hn::Mul(hn::Sub(part.high, part.low), a.height);
  const V cosine = hn::MulAdd(hn::Mul(part.low, part.high), a.length,
                              hn::MulAdd(hn::Add(part.low, part.high), a.slope, a.square));
  const V angle = hn::Add(hn::Atan(d, hn::Div(sine, cosine)),
                          hn::IfThenElseZero(hn::Lt(cosine, zero), hn::Set(d, std::numbers::pi)));
  return hn::IfThenElseZero(some, hn::Mul(angle, a.weight));
}

// Intervals of one edge that cones cover, sorted by where they begin.
class Cover {
 public:
  Cover(double* memory, D d) : low_(memory, d), high_(memory, d), d_(d), memory_(memory) {}

  void reset(std::size_t capacity) {
    high_ = Numbers(memory_ + capacity * hn::Lanes(d_), d_);
    count_ = 0;
  }

  // Empty lanes are put behind everything, where they cover nothing.
  HWY_INLINE void add(const Interval& part) {
    const auto some = hn::Gt(part.high, part.low);
    if (hn::AllFalse(d_, some)) return;
    const V behind = hn::Set(d_, 2.0);
    V low = hn::IfThenElse(some, part.low, behind), high = hn::IfThenElse(some, part.high, behind);
    for (std::size_t k = 0; k < count_; ++k) {
      const V l = low_[k], h = high_[k];
      const auto before = hn::Lt(low, l);
      low_.set(k, hn::IfThenElse(before, low, l));
      high_.set(k, hn::IfThenElse(before, high, h));
      low = hn::IfThenElse(before, l, low);
      high = hn::IfThenElse(before, h, high);
    }
    low_.set(count_, low);
    high_.set(count_, high);
    ++count_;
  }

  // Lambert's sum over the part of `whole` that nothing covers.
  HWY_INLINE V uncovered(const Arc& a, const Interval& whole) const {
    V sum = hn::Zero(d_), at = whole.low;
    for (std::size_t k = 0; k < count_; ++k) {
      sum = hn::Add(sum, lambert(d_, a, {at, hn::Min(low_[k], whole.high)}));
      at = hn::Max(at, high_[k]);
    }
    return hn::Add(sum, lambert(d_, a, {at, whole.high}));
  }

  // Lambert's sum over the union of the intervals, which lie in [0, 1].
  HWY_INLINE V covered(const Arc& a) const {
    V sum = hn::Zero(d_);
    if (count_ == 0) return sum;
    const V one = hn::Set(d_, 1.0);
    V begin = low_[0], end = high_[0];
    for (std::size_t k = 1; k < count_; ++k) {
      const V l = low_[k], h = high_[k];
      const auto apart = hn::Gt(l, end);
      if (!hn::AllFalse(d_, apart)) {
        sum = hn::Add(sum, hn::IfThenElseZero(apart, lambert(d_, a, {begin, hn::Min(end, one)})));
        begin = hn::IfThenElse(apart, l, begin);
      }
      end = hn::Max(end, h);
    }
    // empty lanes lie at 2
    return hn::Add(sum, hn::IfThenElseZero(hn::Lt(begin, one), lambert(d_, a, {begin, hn::Min(end, one)})));
  }

 private:
  Numbers low_, high_;
  D d_;
  double* memory_;
  std::size_t count_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace luxel
HWY_AFTER_NAMESPACE();

#endif
