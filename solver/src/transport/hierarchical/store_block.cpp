#include "transport/hierarchical/store_block.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "form_factors/pair.h"

namespace luxel {

namespace {

// A side is taken for constant where that changes the irradiance by less than this share of the block's
// error: little, since neighbouring blocks slope alike.
constexpr double collapse_share = 0.1;

// An exact pair of patches may err by this share of the block's error.
constexpr double near_share = 0.1;

// Shares that rays found are means over quarters of an end, whose middles are sqrt(3) / 2 as far out as its
// nodes: both slopes are scaled up to these, or the irradiance would change too little across the end.
// The end's nodes are pair & first and pair & second.
void extend_to_nodes(std::array<double, 16>& shares, int first, int second) {
  constexpr double further = 2 / std::numbers::sqrt3;
  for (const int axis : {first, second}) {
    for (int k = 0; k < 16; ++k) {
      if (k & axis) continue;
      const double mean = 0.5 * (shares[k] + shares[k | axis]);
      shares[k] = mean + further * (shares[k] - mean);
      shares[k | axis] = mean + further * (shares[k | axis] - mean);
    }
  }
}

// Scales shares so that the nodes' weights give the mean that the rays found, which are spread by area: where
// an end is no rectangle, the parts around its nodes have other areas than the nodes have weights.
void keep_mean(std::array<double, 16>& shares, const BlockEnd& r, const BlockEnd& s,
               const BlockKernel& kernel, const RayCount& rays) {
  double cast = 0, arrived = 0, all = 0, visible = 0;
  for (int k = 0; k < 16; ++k) {
    cast += kernel.values[k] * rays.cast[k];
    arrived += kernel.values[k] * rays.arrived[k];
    const double weight = r.weights[k >> 2] * s.weights[k & 3] * kernel.values[k];
    all += weight;
    visible += weight * shares[k];
  }
  if (!(visible > 0 && cast > 0)) return;
  const double scale = arrived / cast * all / visible;
  for (double& share : shares) share *= scale;
}

}  // namespace

void store_block(const BlockEnd& r, const BlockEnd& s, const BlockKernel& kernel, const RayCount& rays,
                 const BlockTolerance& tolerance, BlockList& list) {
  std::array<double, 16> values = kernel.values;
  if (rays.all > 0) {
    std::array<double, 16> shares;
    for (int k = 0; k < 16; ++k) shares[k] = rays.share(k);
    if (!rays.unanimous()) {
      keep_mean(shares, r, s, kernel, rays);
      if (!r.single) extend_to_nodes(shares, 4, 8);
      if (!s.single) extend_to_nodes(shares, 1, 2);
    }
    for (int k = 0; k < 16; ++k) values[k] *= shares[k];
  }
  std::array<double, 4> of_r{}, of_s{};
  double mean = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      of_r[a] += s.weights[b] * values[4 * a + b];
      of_s[b] += r.weights[a] * values[4 * a + b];
    }
  }
  for (int a = 0; a < 4; ++a) mean += r.weights[a] * of_r[a];
  double along_r = 0, along_s = 0;  // largest change of the kernel if a side is taken for constant
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      along_r = std::max(along_r, std::abs(values[4 * a + b] - of_s[b]));
      along_s = std::max(along_s, std::abs(values[4 * a + b] - of_r[a]));
    }
  }
  const double weight = std::max(s.area * tolerance.bright_s, r.area * tolerance.bright_r);
  const double small = collapse_share * tolerance.error;
  const bool constant_r = r.single || along_r * weight <= small;
  const bool constant_s = s.single || along_s * weight <= small;
  const auto narrow = [](const auto& wide, auto& result) {
    for (std::size_t k = 0; k < wide.size(); ++k) result[k] = static_cast<float>(wide[k]);
  };
  if (constant_r && constant_s) {
    list.scalars.push_back({r.cluster, s.cluster, static_cast<float>(mean)});
    list.entries += r.single && s.single;
  } else if (constant_s) {
    narrow(of_r, list.linears.emplace_back(LinearBlock{r.cluster, s.cluster, {}}).values);
  } else if (constant_r) {
    narrow(of_s, list.linears.emplace_back(LinearBlock{s.cluster, r.cluster, {}}).values);
  } else {
    narrow(values, list.bilinears.emplace_back(BilinearBlock{r.cluster, s.cluster, {}}).values);
  }
}

void store_near_block(const BlockEnd& r, const BlockEnd& s, double visible, const BlockTolerance& tolerance,
                      BlockList& list) {
  const Polygon p = clip(r.bounds.hull, s.bounds.plane, plane_tolerance);
  const Polygon q = clip(s.bounds.hull, r.bounds.plane, plane_tolerance);
  if (p.count == 0 || q.count == 0) return;
  const double brightest = std::max(tolerance.bright_r, tolerance.bright_s);
  const double of_area = near_share * std::min(tolerance.error / brightest, 1.0);
  const double exchange = contour_exchange(p, q, of_area * std::min(r.area, s.area));
  if (!(exchange > 0)) return;
  ++list.entries;
  list.scalars.push_back({r.cluster, s.cluster, static_cast<float>(visible * exchange / (r.area * s.area))});
}

}  // namespace luxel
