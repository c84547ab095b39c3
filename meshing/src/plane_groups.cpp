#include "plane_groups.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "order_by_key.h"

namespace luxel {

namespace {

// Cells of a plane's direction (two components of the normal) and distance (share of the scene): fine enough
// that a finely cut sphere has about one facet in each.
constexpr double cells_per_unit = 1024;

// How far the planes of two polygons that lie in one plane may differ, in components of the normal and shares
// of the scene: what seven-digit coordinates do to a polygon of a thousandth of the scene.
constexpr double plane_tolerance = 1e-4;

// Directions without symmetry: no face of an axis-aligned or evenly turned body lies on the border of a cell
// or on that of the half-space of canonical normals.
const Vec3 first_axis(0.8327, 0.2011, 0.5159);
const Vec3 second_axis(-0.3419, 0.9163, 0.2089);
const Vec3 canonical_side(0.3701, 0.5393, 0.7564);

// Bits of the filter for each entry: one in so many planes of its own then takes part in the sort.
constexpr std::uint64_t bits_per_entry = 8;

// Bits of a key: three passes of a radix sort; two planes in 10^10 share one by chance, which costs a test.
constexpr int key_bits = 33;

struct Entry {
  std::uint64_t key;
  int polygon;
};

/// One coordinate of a plane: its cell, and the one beside it where it is near the border.
struct Cells {
  std::int64_t cells[2];
  int count;

  explicit Cells(double x) : count(1) {
    constexpr double near = plane_tolerance * cells_per_unit;
    const double place = x * cells_per_unit;
    const double cell = std::floor(place);
    cells[0] = static_cast<std::int64_t>(cell);
    if (place - cell < near) cells[count++] = cells[0] - 1;
    if (place - cell > 1 - near) cells[count++] = cells[0] + 1;
  }
};

std::uint64_t mixed(std::int64_t a, std::int64_t b, std::int64_t c) {
  std::uint64_t h = 0x9e3779b97f4a7c15ull;
  for (const std::int64_t x : {a, b, c}) {
    h = (h ^ static_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdull;
    h ^= h >> 32;
  }
  return h >> (64 - key_bits);
}

void append(const Vec3& normal, double distance, int polygon, std::vector<Entry>& entries) {
  const Cells a(normal.dot(first_axis)), b(normal.dot(second_axis)), c(distance);
  for (int i = 0; i < a.count; ++i) {
    for (int j = 0; j < b.count; ++j) {
      for (int k = 0; k < c.count; ++k)
        entries.push_back({mixed(a.cells[i], b.cells[j], c.cells[k]), polygon});
    }
  }
}

/// Leaves the entries whose key others seem to have.
void drop_lone(std::vector<Entry>& entries) {
  const std::uint64_t bits = std::bit_ceil(std::max<std::uint64_t>(64, bits_per_entry * entries.size()));
  std::vector<std::uint64_t> once(bits / 64, 0), again(bits / 64, 0);
  for (const Entry& entry : entries) {
    const std::uint64_t place = entry.key & (bits - 1);
    const std::uint64_t bit = std::uint64_t{1} << (place & 63);
    again[place >> 6] |= once[place >> 6] & bit;
    once[place >> 6] |= bit;
  }
  std::erase_if(entries, [&](const Entry& entry) {
    const std::uint64_t place = entry.key & (bits - 1);
    return (again[place >> 6] >> (place & 63) & 1) == 0;
  });
}

}  // namespace

PlaneGroups group_by_plane(const std::vector<Frame>& frames, const Vec3& centre, double size) {
  std::vector<Entry> entries;
  entries.reserve(frames.size() + frames.size() / 2);
  for (int p = 0; p < static_cast<int>(frames.size()); ++p) {
    const Frame& frame = frames[p];
    const double side = frame.n.dot(canonical_side);
    const double distance = frame.n.dot(frame.origin - centre) / size;
    const double sign = side < 0 ? -1 : 1;
    append(sign * frame.n, sign * distance, p, entries);
    if (std::abs(side) < plane_tolerance) append(-sign * frame.n, -sign * distance, p, entries);
  }
  drop_lone(entries);
  std::vector<std::uint64_t> keys;
  keys.reserve(entries.size());
  for (const Entry& entry : entries) keys.push_back(entry.key);
  const std::vector<int> order = order_by_key(keys);
  PlaneGroups groups;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && keys[order[end]] == keys[order[begin]]) ++end;
    if (end - begin < 2) continue;
    for (std::size_t k = begin; k < end; ++k) groups.members.push_back(entries[order[k]].polygon);
    groups.offsets.push_back(static_cast<int>(groups.members.size()));
  }
  return groups;
}

}  // namespace luxel
