#include "sizing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "order_by_key.h"

namespace luxel {

namespace {

// Parts from which on an edge may have one more or fewer: their length then changes by a quarter at most.
constexpr int parts_to_trim = 4;

}  // namespace

int Sizing::parts(double length, double turn) const {
  const int least = static_cast<int>(std::ceil(length / longest));
  const int even = std::max({1, least, static_cast<int>(std::lround(length / at(turn)))});
  if (even < parts_to_trim || turn >= std::abs(trim)) return even;
  return trim > 0 ? even + 1 : even - 1;
}

Turns take_turns(const std::vector<int>& polygons, const std::vector<std::vector<int>>& edges_of,
                 int polygon_count, int edge_count) {
  Turns turns;
  turns.of_polygon.assign(polygon_count, 1);
  turns.of_edge.assign(edge_count, 1);
  const double step = 1.0 / (static_cast<double>(polygons.size()) + edge_count);
  double turn = 0;
  for (const int place : scattered_order(static_cast<int>(polygons.size()))) {
    for (const int e : edges_of[place]) {
      if (turns.of_edge[e] < 1) continue;
      turns.of_edge[e] = turn;
      turn += step;
    }
    turns.of_polygon[polygons[place]] = turn;
    turn += step;
  }
  return turns;
}

std::vector<int> scattered_order(int count) {
  // Multiples of the golden ratio, modulo 1, fill the interval evenly at every length: those places come
  // first whose multiple is smallest. Source: H. Niederreiter, Random number generation and quasi-Monte Carlo
  // methods, 1992, ch. 3.
  constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15ull;  // its fraction, in 2^-64
  std::vector<std::uint64_t> keys(count);
  for (int i = 0; i < count; ++i) keys[i] = golden_ratio * static_cast<std::uint64_t>(i);
  return order_by_key(keys);
}

}  // namespace luxel
