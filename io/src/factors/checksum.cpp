#include "factors/checksum.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace luxel {

namespace {

/// One round of xxHash64 (Collet 2012).
std::uint64_t stirred(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * 0xc2b2ae3d27d4eb4fu, 31) * 0x9e3779b185ebca87u;
}

}  // namespace

void Checksum::add_block(const char* bytes) {
  std::uint64_t words[4];
  std::memcpy(words, bytes, block);
  for (int k = 0; k < 4; ++k) lanes_[k] = stirred(lanes_[k], words[k]);
}

void Checksum::add(std::string_view bytes) {
  total_ += bytes.size();
  if (rest_size_ > 0) {
    const std::size_t taken = std::min(block - rest_size_, bytes.size());
    std::memcpy(rest_ + rest_size_, bytes.data(), taken);
    rest_size_ += taken;
    bytes.remove_prefix(taken);
    if (rest_size_ < block) return;
    add_block(rest_);
    rest_size_ = 0;
  }
  for (; bytes.size() >= block; bytes.remove_prefix(block)) add_block(bytes.data());
  if (!bytes.empty()) std::memcpy(rest_, bytes.data(), bytes.size());
  rest_size_ = bytes.size();
}

std::uint64_t Checksum::value() const {
  Checksum last = *this;
  if (last.rest_size_ > 0) {
    std::memset(last.rest_ + last.rest_size_, 0, block - last.rest_size_);
    last.add_block(last.rest_);
  }
  std::uint64_t sum = total_;
  for (std::uint64_t lane : last.lanes_) sum = stirred(sum, lane);
  return sum ^ sum >> 29;
}

}  // namespace luxel
