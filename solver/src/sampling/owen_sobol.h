#pragma once

#include <array>
#include <cstdint>

namespace luxel {

/// Quasi-random points in [0, 1)^4: the Sobol sequence (direction numbers of Joe and Kuo 2008) under nested
/// uniform scrambling (Owen 1995, by the hash of Laine and Karras 2011). The first 2^k points of any seed,
/// and each aligned run of 2^k, are a stratified net; different seeds are independent.
class OwenSobol4 {
 public:
  explicit OwenSobol4(std::uint64_t seed);

  /// Point `index` of the sequence. Cost: about 20 ns.
  std::array<double, 4> operator()(std::uint32_t index) const;

 private:
  std::array<std::uint32_t, 4> seeds_;
};

/// Mixes numbers into one seed: different (stream, item) give independent streams.
std::uint64_t mixed_seed(std::uint64_t stream, std::uint64_t item);

}  // namespace luxel
