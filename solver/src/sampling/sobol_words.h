#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace luxel {

/// The first `count` points of the four-dimensional Sobol sequence (direction numbers of Joe and Kuo 2008) as
/// 32-bit fractions with their bits reversed, 4 words a point: what a nested uniform scrambling by hashing
/// begins with.
std::vector<std::uint32_t> reversed_sobol_words(int count);

/// The hash of Laine and Karras (2011) in the version of Vegdahl (2021), on words with their bits reversed:
/// each bit is flipped by a hash of the bits below it, which is a nested uniform scrambling of the fraction.
struct LaineKarras {
  static constexpr std::uint32_t first = 0x3d20adeau, second = 0x05526c56u, third = 0x53a22864u;

  constexpr std::uint32_t operator()(std::uint32_t reversed_word, std::uint32_t seed) const {
    std::uint32_t x = reversed_word;
    x ^= x * first;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * second;
    x ^= x * third;
    return x;
  }
};

constexpr std::uint32_t bits_reversed(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

}  // namespace luxel
