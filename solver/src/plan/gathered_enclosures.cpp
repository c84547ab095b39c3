#include "plan/gathered_enclosures.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "enclosures/union_find.h"
#include "transport/gather/packets.h"

namespace luxel {

namespace {

// Rays of a patch that are joined at once; they connect nearly all, so that the others are only compared.
constexpr std::size_t joining_rays = 8;

constexpr std::size_t packets_a_task = 64;

}  // namespace

Enclosures gathered_enclosures(const GatherOperator& stored, const std::vector<double>& row_sums, int rays) {
  constexpr std::size_t lanes = GatherOperator::lanes;
  const int size = stored.size();
  const auto packets = stored.packets();
  UnionFind sets(size);
  std::vector<int> root(size);
  const auto each_hit = [&](std::size_t first, std::size_t last, auto&& join) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, packets.size(), packets_a_task),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t p = range.begin(); p < range.end(); ++p) {
                          const auto met = stored.hits(p);
                          const std::size_t used = used_lanes(packets[p]);
                          for (std::size_t q = first; q < last; ++q) {
                            for (std::size_t k = 0; k < used; ++k) {
                              const std::uint32_t end = met[q * lanes + k];
                              if (end < static_cast<std::uint32_t>(size)) {
                                join(packets[p][k], static_cast<int>(end));
                              }
                            }
                          }
                        }
                      });
  };
  const std::size_t all = stored.rays(), few = std::min(all, joining_rays);
  each_hit(0, few, [&](int a, int b) { sets.join(a, b); });
  for (int i = 0; i < size; ++i) root[i] = sets.root(i);
  each_hit(few, all, [&](int a, int b) {
    if (root[a] != root[b]) sets.join(a, b);
  });

  Enclosures result;
  result.enclosure.resize(size);
  result.back_share.assign(size, 0.0);
  result.share_rays.assign(size, static_cast<int>(rays));
  for (int i = 0; i < size; ++i) {
    const int first = sets.root(i);
    if (first == i) {
      result.enclosure[i] = result.count++;
      result.enclosure_closed.push_back(1);
    } else {
      result.enclosure[i] = result.enclosure[first];
    }
    const double open = 1 - row_sums[i];
    result.open_share.push_back(open);
    if (open > 0) result.enclosure_closed[result.enclosure[i]] = 0;
  }
  // where an enclosure is open, that all rays of a patch agree is no proof
  for (int i = 0; i < size; ++i) {
    const double open = result.open_share[i];
    const bool closed = result.enclosure_closed[result.enclosure[i]];
    result.share_error.push_back(closed ? 0 : std::max(1.0 / rays, std::sqrt(open * (1 - open) / rays)));
  }
  result.closed = size > 0 && std::all_of(result.enclosure_closed.begin(), result.enclosure_closed.end(),
                                          [](char closed) { return closed != 0; });
  return result;
}

}  // namespace luxel
