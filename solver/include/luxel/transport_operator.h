#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace luxel {

class ExchangeMatrix;

/// The transport operator F: irradiance from radiosity, H = F B, without colour. Row i holds the shares F_ij
/// of what leaves patch i that arrive at patch j. Immutable and safe to use from many threads.
///
/// To add one more operator: derive from this in solver/src/transport/<name>_operator.*, declare its maker in
/// solver/include/luxel/<name>_operator.h, and name it in transport.h. Every iterative solver then works on
/// it.
class TransportOperator {
 public:
  virtual ~TransportOperator() = default;

  /// Number of patches N.
  virtual int size() const = 0;

  /// Y = F X for `columns` right-hand sides at once. x and y are N x columns, row-major, owned by the caller,
  /// and do not overlap. The same x gives the same bits for any number of threads.
  virtual void apply(const double* x, double* y, int columns) const = 0;

  /// s_i = sum_j F_ij in float64, of the operator as apply() uses it; N numbers, 1 in closed scenes.
  virtual std::span<const double> row_sums() const = 0;

  /// Patch areas A_i, N numbers [m2].
  virtual std::span<const double> areas() const = 0;

  /// Whether A_i F_ij = A_j F_ji holds exactly, so that conjugate gradients and Cholesky apply.
  virtual bool symmetric() const = 0;

  /// Memory held by the operator [bytes].
  virtual std::size_t bytes() const = 0;

  /// "dense", "gather" or "hierarchical".
  virtual std::string_view kind() const = 0;

  /// The exchange areas A_i F_ij entry by entry, where the operator has them; nullptr else. Their diagonal
  /// (see diagonal()) belongs to the operator too.
  virtual const ExchangeMatrix* entries() const { return nullptr; }

  /// Diagonal exchange areas A_i F_ii in float64 that go with entries(): the rounding of the stored entries
  /// (flat patches do not see themselves), so that row sums are right to float64. Empty where entries() is
  /// nullptr.
  virtual std::span<const double> diagonal() const { return {}; }
};

}  // namespace luxel
