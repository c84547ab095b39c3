#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "form_factors/hidden_kernel.cpp"
#include <hwy/foreach_target.h>  // first, so that the rest is compiled once per target
#include <hwy/highway.h>
//
#include <hwy/contrib/math/math-inl.h>

#include <cstdint>
#include <numbers>

#include "form_factors/hidden_kernel.h"

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

// The sweep over the edges for as many eyes as a vector has lanes.
class Batch {
 public:
  static std::size_t memory(std::size_t corners, std::size_t edges, std::size_t cones) {
    return (6 * corners + 9 * edges + 2 * (cones + 1)) * hn::Lanes(D());
  }

  Batch(const Vec3s& eye, const Vec3& normal, const Polygon& inner, const Shadows& shadows, double* memory)
      : normal_(broadcast(d_, normal)),
        shadows_(shadows),
        corners_(static_cast<std::size_t>(inner.count)),
        sight_(memory, d_),
        inward_(memory + 3 * corners_ * hn::Lanes(d_), d_),
        p_(memory + 6 * corners_ * hn::Lanes(d_), d_),
        q_(memory + (6 * corners_ + 3 * shadows.edges.size()) * hn::Lanes(d_), d_),
        bound_(memory + (6 * corners_ + 6 * shadows.edges.size()) * hn::Lanes(d_), d_),
        cover_(memory + (6 * corners_ + 9 * shadows.edges.size()) * hn::Lanes(d_), d_) {
    for (std::size_t k = 0; k < corners_; ++k) {
      sight_.set(k, minus(broadcast(d_, inner.corners[k]), eye));
    }
    for (std::size_t k = 0; k < corners_; ++k) inward_.set(k, cross(sight_[next(k)], sight_[k]));
    for (std::size_t e = 0; e < shadows.edges.size(); ++e) {
      const Vec3s p = minus(broadcast(d_, shadows.edges[e].p), eye);
      const Vec3s q = minus(broadcast(d_, shadows.edges[e].q), eye);
      p_.set(e, p);
      q_.set(e, q);
      bound_.set(e, cross(q, p));
    }
  }

  V hidden() {
    V sum = hn::Zero(d_);
    for (std::size_t k = 0; k < corners_; ++k) sum = hn::Add(sum, inner_edge(k));
    for (int cone = 0; cone < shadows_.count(); ++cone) {
      for (int e = shadows_.begin[cone]; e < shadows_.begin[cone + 1]; ++e) {
        sum = hn::Add(sum, shadow_edge(cone, e));
      }
    }
    return hn::Mul(sum, hn::Set(d_, 0.5 / std::numbers::pi));
  }

 private:
  std::size_t next(std::size_t k) const { return k + 1 < corners_ ? k + 1 : 0; }

  // The part of the inner polygon's edge k that the shadows hide.
  V inner_edge(std::size_t k) {
    const Vec3s from = sight_[k], to = sight_[next(k)];
    cover_.reset(shadows_.begin.size());
    for (int cone = 0; cone < shadows_.count(); ++cone) {
      Interval part{hn::Zero(d_), hn::Set(d_, 1.0)};
      for (int e = shadows_.begin[cone]; e < shadows_.begin[cone + 1]; ++e) {
        const Vec3s bound = bound_[e];
        keep_positive(d_, dot(bound, from), dot(bound, to), part);
      }
      cover_.add(part);
    }
    return cover_.covered(arc(d_, from, to, inward_[k], normal_));
  }

  // The part of a cone's edge in the inner polygon that no other cone hides.
  V shadow_edge(int cone, int e) {
    const Vec3s p = p_[e], q = q_[e];
    Interval whole{hn::Zero(d_), hn::Set(d_, 1.0)};
    for (std::size_t k = 0; k < corners_; ++k) {
      const Vec3s inward = inward_[k];
      keep_positive(d_, dot(inward, p), dot(inward, q), whole);
    }
    if (shadows_.cut[cone]) {
      for (int other = shadows_.begin[cone]; other < shadows_.begin[cone + 1]; ++other) {
        if (other == e) continue;
        const Vec3s bound = bound_[other];
        keep_positive(d_, dot(bound, p), dot(bound, q), whole);
      }
    }
    if (hn::AllFalse(d_, hn::Gt(whole.high, whole.low))) return hn::Zero(d_);
    cover_.reset(shadows_.begin.size());
    for (int other = 0; other < shadows_.count(); ++other) {
      if (other != cone) cover_by(cone, e, other, p, q, whole);
    }
    return cover_.uncovered(arc(d_, p, q, bound_[e], normal_), whole);
  }

  // Where edge e lies on an edge of the other cone, that edge does not decide: of two cones on the same side
  // the first one's edge counts, of two on opposite sides both count and cancel.
  void cover_by(int cone, int e, int other, const Vec3s& p, const Vec3s& q, Interval part) {
    for (int o = shadows_.begin[other]; o < shadows_.begin[other + 1]; ++o) {
      const int tie = shadows_.tie(e, o);
      if (tie < 0 || (tie > 0 && cone < other)) return;
      if (tie > 0) continue;
      const Vec3s bound = bound_[o];
      keep_positive(d_, dot(bound, p), dot(bound, q), part);
    }
    cover_.add(part);
  }

  D d_;
  Vec3s normal_;
  const Shadows& shadows_;
  std::size_t corners_;
  Vectors sight_, inward_;  // per corner: the corner from the eye, inward normal of the edge that it begins
  Vectors p_, q_, bound_;   // per shadow edge: its ends from the eye, the inward normal of its plane
  Cover cover_;
};

void HiddenShares(const OuterPoints& points, const Vec3& normal, const Polygon& inner, const Shadows& shadows,
                  HiddenWorkspace& workspace, std::vector<double>& shares) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), count = points.size(), padded = (count + lanes - 1) / lanes * lanes;
  const std::size_t batch =
      Batch::memory(static_cast<std::size_t>(inner.count), shadows.edges.size(), shadows.begin.size());
  double* memory = workspace.reserve(batch + 3 * padded);
  double *x = memory + batch, *y = x + padded, *z = y + padded;
  for (std::size_t k = 0; k < padded; ++k) {
    const std::size_t source = k < count ? k : count - 1;
    x[k] = points.x[source];
    y[k] = points.y[source];
    z[k] = points.z[source];
  }
  shares.resize(padded);
  for (std::size_t k = 0; k < padded; k += lanes) {
    Batch eyes({hn::Load(d, x + k), hn::Load(d, y + k), hn::Load(d, z + k)}, normal, inner, shadows, memory);
    hn::StoreU(eyes.hidden(), d, shares.data() + k);
  }
  shares.resize(count);
}

}  // namespace HWY_NAMESPACE
}  // namespace luxel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(HiddenShares);

void hidden_shares(const OuterPoints& points, const Vec3& normal, const Polygon& inner,
                   const Shadows& shadows, HiddenWorkspace& workspace, std::vector<double>& shares) {
  shares.clear();
  if (points.size() == 0) return;
  HWY_DYNAMIC_DISPATCH(HiddenShares)(points, normal, inner, shadows, workspace, shares);
}

}  // namespace luxel
#endif
