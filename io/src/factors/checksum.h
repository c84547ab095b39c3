#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace luxel {

/// A 64-bit checksum of bytes that come in pieces; how they are cut does not matter. It finds damage, not
/// malice. Cost: about 0.1 ns a byte.
class Checksum {
 public:
  void add(std::string_view bytes);
  std::uint64_t value() const;

 private:
  static constexpr std::size_t block = 32;

  void add_block(const char* bytes);

  std::uint64_t lanes_[4] = {0x243f6a8885a308d3u, 0x13198a2e03707344u, 0xa4093822299f31d0u,
                             0x082efa98ec4e6c89u};
  char rest_[block] = {};
  std::size_t rest_size_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace luxel
