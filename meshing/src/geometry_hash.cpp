#include <bit>
#include <cstdint>

#include "luxel/patch_mesh.h"

namespace luxel {

namespace {

/// A 64-bit hash of words: each is mixed in by multiplication and a shift (the finaliser of MurmurHash3).
class Hash {
 public:
  void add(std::uint64_t word) {
    state_ = (state_ ^ word) * 0xff51afd7ed558ccdull;
    state_ ^= state_ >> 33;
    state_ *= 0xc4ceb9fe1a85ec53ull;
    state_ ^= state_ >> 29;
  }
  // Adding 0 makes -0.0 and 0.0 the same place.
  void add(const Vec3& p) {
    for (const double x : p) add(std::bit_cast<std::uint64_t>(x + 0.0));
  }
  template <std::size_t N>
  void add(const std::array<int, N>& row) {
    for (const int x : row) add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)));
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0x6c7578656cull;
};

template <class Row>
void add_all(Hash& hash, const std::vector<Row>& rows) {
  hash.add(static_cast<std::uint64_t>(rows.size()));
  for (const Row& row : rows) hash.add(row);
}

}  // namespace

std::uint64_t geometry_hash(const PatchMesh& mesh) {
  Hash hash;
  add_all(hash, mesh.vertices);
  add_all(hash, mesh.corners);
  add_all(hash, mesh.occluders.vertices);
  add_all(hash, mesh.occluders.triangles);
  return hash.value();
}

}  // namespace luxel
