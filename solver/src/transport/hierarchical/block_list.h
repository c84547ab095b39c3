#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace luxel {

/// Blocks in working units, each stored once and used both ways. Ends are clusters or single patches by their
/// number in the hierarchy. Irradiance at an end's nodes is the sum over the other's nodes of kernel times
/// light, light = radiosity times area of the node.
struct ScalarBlock {
  int r = 0, s = 0;  ///< equal at all nodes of both
  float value = 0;
};
struct LinearBlock {
  int r = 0, s = 0;  ///< differs between the nodes of r, equal at those of s
  std::array<float, 4> values{};
};
struct BilinearBlock {
  int r = 0, s = 0;
  std::array<float, 16> values{};  ///< [4 a + b], a a node of r and b of s
};

/// What one task of the assembly found.
struct BlockList {
  std::vector<ScalarBlock> scalars;
  std::vector<LinearBlock> linears;
  std::vector<BilinearBlock> bilinears;
  std::int64_t entries = 0;  ///< of the scalars: between two single patches
  std::int64_t unhidden = 0;
  std::int64_t hidden = 0;
  std::int64_t rays = 0;

  /// Gives back memory that it has not used.
  void shrink() {
    scalars.shrink_to_fit();
    linears.shrink_to_fit();
    bilinears.shrink_to_fit();
  }
  std::size_t size() const { return scalars.size() + linears.size() + bilinears.size(); }
};

}  // namespace luxel
