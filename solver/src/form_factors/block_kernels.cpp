#include "form_factors/block_kernels.h"

#include <numbers>
#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "form_factors/block_kernels.cpp"
// Highway compiles this file once per instruction set; the order of its headers matters.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace luxel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Tag>;

// 1 / x: the single precision estimate (11 bits at least) with Newton steps, each of which doubles the bits.
template <int steps>
HWY_INLINE Lanes reciprocal(const Lanes x) {
  const Tag d;
  const hn::Rebind<float, Tag> half;
  Lanes r = hn::PromoteTo(d, hn::ApproximateReciprocal(hn::DemoteTo(half, x)));
  for (int step = 0; step < steps; ++step) r = hn::Mul(r, hn::NegMulAdd(x, r, hn::Set(d, 2.0)));
  return r;
}

// Lanes hold target patches j; each pair costs count^2 point pairs. The cosine at x depends on y's point
// only, because x's plane is fixed, and the other way round: both leave the inner loop.
template <int count, int steps>
void FillRows(const PatchPoints& points, const PatchPlanes& planes, int i0, int i1, int j0, int j1,
              Tile& tile) {
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int j = j0; j < j1; j += lanes) {
    Lanes yx[count], yy[count], yz[count], yw[count];
    for (int k = 0; k < count; ++k) {
      const std::size_t at = static_cast<std::size_t>(k) * points.stride + j;
      yx[k] = hn::LoadU(d, &points.x[at]);
      yy[k] = hn::LoadU(d, &points.y[at]);
      yz[k] = hn::LoadU(d, &points.z[at]);
      yw[k] = hn::LoadU(d, &points.weight[at]);
    }
    const Lanes nx = hn::LoadU(d, &planes.nx[j]), ny = hn::LoadU(d, &planes.ny[j]);
    const Lanes nz = hn::LoadU(d, &planes.nz[j]), offset = hn::LoadU(d, &planes.offset[j]);
    for (int i = i0; i < i1; ++i) {
      Lanes sums[count];
      for (int k = 0; k < count; ++k) sums[k] = hn::Zero(d);
      for (int a = 0; a < count; ++a) {
        const std::size_t at = static_cast<std::size_t>(a) * points.stride + i;
        const Lanes x = hn::Set(d, points.x[at]), y = hn::Set(d, points.y[at]), z = hn::Set(d, points.z[at]);
        Lanes cosine = hn::MulAdd(nx, x, hn::MulAdd(ny, y, hn::MulSub(nz, z, offset)));
        cosine = hn::Mul(cosine, hn::Set(d, points.weight[at]));
        for (int k = 0; k < count; ++k) {
          const Lanes dx = hn::Sub(x, yx[k]), dy = hn::Sub(y, yy[k]), dz = hn::Sub(z, yz[k]);
          const Lanes square = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
          const Lanes inverse = reciprocal<steps>(square);
          sums[k] = hn::MulAdd(cosine, hn::Mul(inverse, inverse), sums[k]);
        }
      }
      const Lanes px = hn::Set(d, planes.nx[i]), py = hn::Set(d, planes.ny[i]);
      const Lanes pz = hn::Set(d, planes.nz[i]), po = hn::Set(d, planes.offset[i]);
      Lanes sum = hn::Zero(d);
      for (int k = 0; k < count; ++k) {
        Lanes cosine = hn::MulAdd(px, yx[k], hn::MulAdd(py, yy[k], hn::MulSub(pz, yz[k], po)));
        sum = hn::MulAdd(hn::Mul(cosine, yw[k]), sums[k], sum);
      }
      // The padding to whole vectors stays inside the tile's row.
      hn::StoreU(hn::Mul(sum, hn::Set(d, 1 / std::numbers::pi)), d,
                 tile.values + (i - i0) * Tile::columns + (j - j0));
    }
  }
}

template <int count>
void FillRows(const PatchPoints& points, const PatchPlanes& planes, int i0, int i1, int j0, int j1, bool fine,
              Tile& tile) {
  if (fine) {
    FillRows<count, 3>(points, planes, i0, i1, j0, j1, tile);
  } else {
    FillRows<count, 1>(points, planes, i0, i1, j0, j1, tile);
  }
}

void FillTile(const PatchPoints& points, const PatchPlanes& planes, int i0, int i1, int j0, int j1, bool fine,
              Tile& tile) {
  switch (points.count) {
    case 1:
      return FillRows<1>(points, planes, i0, i1, j0, j1, fine, tile);
    case 3:
      return FillRows<3>(points, planes, i0, i1, j0, j1, fine, tile);
    case 4:
      return FillRows<4>(points, planes, i0, i1, j0, j1, fine, tile);
    case 6:
      return FillRows<6>(points, planes, i0, i1, j0, j1, fine, tile);
    case 9:
      return FillRows<9>(points, planes, i0, i1, j0, j1, fine, tile);
    case 12:
      return FillRows<12>(points, planes, i0, i1, j0, j1, fine, tile);
    case 16:
      return FillRows<16>(points, planes, i0, i1, j0, j1, fine, tile);
    default:
      throw std::invalid_argument("no kernel for this many points");
  }
}

}  // namespace
}  // namespace luxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace luxel {

HWY_EXPORT(FillTile);

void fill_tile(const PatchPoints& points, const PatchPlanes& planes, int i0, int i1, int j0, int j1,
               bool fine, Tile& tile) {
  HWY_DYNAMIC_DISPATCH(FillTile)(points, planes, i0, i1, j0, j1, fine, tile);
}

}  // namespace luxel
#endif
