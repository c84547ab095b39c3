#include "manifold_parts.h"

#include <algorithm>

namespace luxel {

namespace {

/// Whether a half-edge mesh can hold this edge.
bool is_manifold(const EdgeTable& edges, std::span<const int> uses) {
  return uses.size() == 1 || (uses.size() == 2 && edges.from(uses[0]) != edges.from(uses[1]));
}

std::vector<char> loops_of_manifold_parts(const Loops& loops, const EdgeTable& edges) {
  std::vector<char> manifold(loops.size(), true);
  std::vector<char> visited(loops.size(), false);
  std::vector<int> part;
  for (int seed = 0; seed < loops.size(); ++seed) {
    if (visited[seed]) continue;
    visited[seed] = true;
    part.assign(1, seed);
    bool all = true;
    for (std::size_t next = 0; next < part.size(); ++next) {
      for (int h = loops.offsets[part[next]]; h < loops.offsets[part[next] + 1]; ++h) {
        const auto uses = edges.uses(h);
        all = all && is_manifold(edges, uses);
        for (const int g : uses) {
          if (visited[edges.loop(g)]) continue;
          visited[edges.loop(g)] = true;
          part.push_back(edges.loop(g));
        }
      }
    }
    if (!all) {
      for (const int i : part) manifold[i] = false;
    }
  }
  return manifold;
}

}  // namespace

ManifoldParts find_manifold_parts(const Loops& loops, const EdgeTable& edges) {
  ManifoldParts parts{loops_of_manifold_parts(loops, edges), {}, {}};
  parts.fans.assign(loops.entries.size(), -1);
  const auto opposite = [&](int h) {
    const auto uses = edges.uses(h);
    return uses.size() == 1 ? -1 : uses[0] + uses[1] - h;
  };
  const auto before = [&](int h) {
    const int begin = loops.offsets[edges.loop(h)];
    return (h > begin ? h : loops.offsets[edges.loop(h) + 1]) - 1;
  };
  const auto after = [&](int h) {
    const int end = loops.offsets[edges.loop(h) + 1];
    return h + 1 < end ? h + 1 : loops.offsets[edges.loop(h)];
  };
  for (int seed = 0; seed < static_cast<int>(parts.fans.size()); ++seed) {
    if (!parts.manifold[edges.loop(seed)] || parts.fans[seed] >= 0) continue;
    const int fan = static_cast<int>(parts.fan_vertices.size());
    parts.fan_vertices.push_back(edges.from(seed));
    int h = seed;  // leaves the vertex; turn one way until the border or the whole round, then the other way
    while (h >= 0 && parts.fans[h] < 0) {
      parts.fans[h] = fan;
      h = opposite(before(h));
    }
    int inwards = opposite(seed);
    while (inwards >= 0 && parts.fans[after(inwards)] < 0) {
      parts.fans[after(inwards)] = fan;
      inwards = opposite(after(inwards));
    }
  }
  return parts;
}

}  // namespace luxel
