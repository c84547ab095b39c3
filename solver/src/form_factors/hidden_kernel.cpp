#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "form_factors/hidden_kernel.cpp"
#include <hwy/foreach_target.h>  // first, so that the rest is compiled once per target
#include <hwy/highway.h>
//
#include <numbers>

#include "form_factors/hidden_arcs-inl.h"
#include "form_factors/hidden_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace luxel {
namespace HWY_NAMESPACE {

// The sweep over the edges for as many eyes as a vector has lanes.
class Batch {
 public:
  static std::size_t memory(std::size_t corners, std::size_t edges, std::size_t cones) {
    return (6 * corners + 10 * edges + 2 * (cones + 1)) * hn::Lanes(D());
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
        active_(memory + (6 * corners_ + 9 * shadows.edges.size()) * hn::Lanes(d_), d_),
        cover_(memory + (6 * corners_ + 10 * shadows.edges.size()) * hn::Lanes(d_), d_) {
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
      if (!shadows.turning.empty()) active_.set(e, hn::Set(d_, 1.0));
    }
    for (const Turning& turning : shadows.turning) turn(eye, turning);
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
  V height(const Vec3s& eye, const Plane& plane) const {
    return hn::Sub(dot(broadcast(d_, plane.normal), eye), hn::Set(d_, plane.offset));
  }

  // Which way round the edge bounds the shadow: not at all where its inward normal becomes 0.
  void turn(const Vec3s& eye, const Turning& turning) {
    const std::size_t e = static_cast<std::size_t>(turning.edge);
    const V zero = hn::Zero(d_), one = hn::Set(d_, 1.0);
    const V left = hn::IfThenElse(hn::Gt(height(eye, turning.left), zero), one, zero);
    const V right = hn::IfThenElse(hn::Gt(height(eye, turning.right), zero), one, zero);
    const V sign = hn::Sub(left, right);
    const Vec3s bound = bound_[e];
    bound_.set(e, {hn::Mul(sign, bound.x), hn::Mul(sign, bound.y), hn::Mul(sign, bound.z)});
    active_.set(e, hn::Abs(sign));
  }

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
    if (!shadows_.turning.empty()) {
      whole.high = hn::IfThenElse(hn::Gt(active_[e], hn::Zero(d_)), whole.high, hn::Set(d_, -1.0));
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
  Numbers active_;          // per shadow edge: 1 where it bounds the shadow, else 0; where any turns
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
