#pragma once

#include <cstddef>
#include <memory>

namespace luxel {

enum class Precision {
  float32,  ///< 4 bytes an entry, rounds at 6e-8
  float64   ///< 8 bytes an entry
};

/// Exchange areas G_ij = A_i F_ij = A_j F_ji of N patches [m2], symmetric with a zero diagonal: the strict
/// lower triangle, packed by rows, so that each pair is stored once. Reciprocity is exact by construction.
class ExchangeMatrix {
 public:
  ExchangeMatrix() = default;
  /// All zero. Memory: N (N - 1) / 2 entries; pages are not touched before they are written.
  /// @throws std::bad_alloc
  ExchangeMatrix(int size, Precision precision);

  int size() const { return size_; }
  Precision precision() const { return precision_; }
  std::size_t entry_count() const { return offset(size_); }
  std::size_t bytes() const { return entry_count() * (precision_ == Precision::float32 ? 4 : 8); }

  /// G_ij for any i, j in [0, N); 0 on the diagonal.
  double operator()(int i, int j) const;
  /// Sets G_ij = G_ji = value, i != j.
  void set(int i, int j, double value);

  /// Forgets the patches from `size` on; their entries keep their memory.
  void keep_first(int size) { size_ = size < size_ ? size : size_; }

  /// Row i of the lower triangle: i entries, those of the pairs (i, 0) .. (i, i - 1). Real must be what
  /// precision() says.
  template <class Real>
  Real* row(int i) {
    return static_cast<Real*>(data_.get()) + offset(i);
  }
  template <class Real>
  const Real* row(int i) const {
    return static_cast<const Real*>(data_.get()) + offset(i);
  }

  /// Index of the first entry of row i.
  static std::size_t offset(int i) {
    return static_cast<std::size_t>(i) * (static_cast<std::size_t>(i) - 1) / 2;
  }

 private:
  struct Free {
    void operator()(void* data) const;
  };
  int size_ = 0;
  Precision precision_ = Precision::float32;
  std::unique_ptr<void, Free> data_;
};

}  // namespace luxel
