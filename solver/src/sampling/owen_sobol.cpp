#include "sampling/owen_sobol.h"

#include <bit>

#include "sampling/sobol_words.h"

namespace luxel {

namespace {

constexpr int bits = 32;

using DirectionNumbers = std::array<std::array<std::uint32_t, bits>, 4>;

/// Joe and Kuo 2008, the first four dimensions: degree s, coefficients a, initial numbers m.
constexpr DirectionNumbers direction_numbers() {
  struct Primitive {
    int degree;
    std::uint32_t coefficients;
    std::array<std::uint32_t, 3> initial;
  };
  constexpr std::array<Primitive, 3> primitives{{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};
  DirectionNumbers v{};
  for (int k = 0; k < bits; ++k) v[0][k] = 1u << (bits - 1 - k);
  for (int d = 1; d < 4; ++d) {
    const auto& [degree, coefficients, initial] = primitives[d - 1];
    for (int k = 0; k < bits; ++k) {
      if (k < degree) {
        v[d][k] = initial[k] << (bits - 1 - k);
        continue;
      }
      v[d][k] = v[d][k - degree] ^ (v[d][k - degree] >> degree);
      for (int q = 1; q < degree; ++q) {
        if (coefficients >> (degree - 1 - q) & 1) v[d][k] ^= v[d][k - q];
      }
    }
  }
  return v;
}

constexpr DirectionNumbers directions = direction_numbers();

/// splitmix64 (Steele, Lea, Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

}  // namespace

std::vector<std::uint32_t> reversed_sobol_words(int count) {
  std::vector<std::uint32_t> words;
  words.reserve(4 * static_cast<std::size_t>(count));
  std::array<std::uint32_t, 4> x{};
  for (std::uint32_t index = 0; index < static_cast<std::uint32_t>(count); ++index) {
    // from index - 1 to index the lowest bits flip, up to and with the lowest zero
    for (std::uint32_t flips = index == 0 ? 0 : index ^ (index - 1); flips != 0; flips &= flips - 1) {
      for (int d = 0; d < 4; ++d) x[d] ^= directions[d][std::countr_zero(flips)];
    }
    for (int d = 0; d < 4; ++d) words.push_back(bits_reversed(x[d]));
  }
  return words;
}

OwenSobol4::OwenSobol4(std::uint64_t seed) {
  for (int d = 0; d < 4; ++d) seeds_[d] = static_cast<std::uint32_t>(mixed(seed + d));
}

std::array<double, 4> OwenSobol4::operator()(std::uint32_t index) const {
  std::array<std::uint32_t, 4> x{};
  for (std::uint32_t rest = index; rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    for (int d = 0; d < 4; ++d) x[d] ^= directions[d][k];
  }
  std::array<double, 4> point;
  for (int d = 0; d < 4; ++d)
    point[d] = bits_reversed(LaineKarras{}(bits_reversed(x[d]), seeds_[d])) * 0x1p-32;
  return point;
}

std::uint64_t mixed_seed(std::uint64_t stream, std::uint64_t item) {
  return mixed(mixed(stream) ^ item * 0xd1342543de82ef95u);
}

}  // namespace luxel
