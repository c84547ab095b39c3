#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "luxel/enclosures.h"
#include "luxel/exchange_matrix.h"
#include "luxel/transport_operator.h"

namespace luxel {

/// How far the rows of an operator are from what they should be.
struct RowSumError {
  double max = 0;  ///< largest |s_i + open_i + back_i - 1|
  double rms = 0;  ///< area-weighted root mean square
  /// What of rms the rays that measured open_i and back_i may have caused: area-weighted RMS of their
  /// standard errors; 0 in closed scenes.
  double sampling_rms = 0;
  double max_beyond_sampling = 0;  ///< largest |..| beyond three standard errors of its row
};

/// What an operator's rows lack, with the shares that the enclosures' rays measured (their own error:
/// enclosures.share_error).
RowSumError row_sum_error(std::span<const double> row_sums, std::span<const double> areas,
                          const Enclosures& enclosures);

/// Symmetric scaling of a closed enclosure's rows to 1, and how much it changed.
struct ClosureReport {
  RowSumError before;             ///< raw
  RowSumError after;              ///< of the operator as returned
  double largest_correction = 0;  ///< largest |factor - 1| that any entry was multiplied by
  bool applied = false;  ///< some enclosure was scaled; false for open scenes: their missing share is sky
  int iterations = 0;    ///< Newton steps
  int unclosed = -1;     ///< a patch of the enclosure that was not closed; -1: none such
  /// The largest correction that was refused, |factor - 1| of an entry; 0: none was.
  double refused_correction = 0;
  std::string message;  ///< one sentence: which enclosure was not closed, and why; else empty
};

/// Row sums s_i = sum_j A_i F_ij / A_i of stored exchange areas, in float64. Cost: one pass.
std::vector<double> row_sums(const ExchangeMatrix& exchange_areas, std::span<const double> areas);

/// The sentences of ClosureReport::message for the enclosure of this patch: no factors close it, or too large
/// ones would.
std::string unclosed_message(int patch);
std::string refused_message(int patch, double correction, double limit);

/// F from stored exchange areas. Symmetric; has entries().
class DenseOperator : public TransportOperator {
 public:
  /// Takes the exchange areas of patches with these areas as they are, with a zero diagonal.
  DenseOperator(ExchangeMatrix exchange_areas, std::vector<double> areas);
  /// With diagonal exchange areas [m2], N numbers.
  DenseOperator(ExchangeMatrix exchange_areas, std::vector<double> areas, std::vector<double> diagonal);

  int size() const override { return exchange_.size(); }
  void apply(const double* x, double* y, int columns) const override;
  std::span<const double> row_sums() const override { return row_sums_; }
  std::span<const double> areas() const override { return areas_; }
  bool symmetric() const override { return true; }
  std::size_t bytes() const override;
  std::string_view kind() const override { return "dense"; }
  const ExchangeMatrix* entries() const override { return &exchange_; }
  std::span<const double> diagonal() const override { return diagonal_; }

 private:
  ExchangeMatrix exchange_;
  std::vector<double> areas_;
  std::vector<double> diagonal_;
  std::vector<double> row_sums_;
};

/// A dense operator and what closing its rows did.
struct ClosedOperator {
  std::unique_ptr<DenseOperator> transport;
  ClosureReport closure;
};

/// Raw exchange areas to an operator: in every closed enclosure the rows are scaled to sum to 1 by G_ij <-
/// d_i d_j G_ij (Newton on log d, conjugate gradients inside), which keeps reciprocity exact and every entry
/// at most min(A_i, A_j); the rounding of the stored entries goes to the diagonal, so that closure holds to
/// 1e-12. Open enclosures are left as they are, and so are closed ones whose rows no factors within [1/4, 4]
/// close. Cost: about 20 passes over the matrix; memory besides: a few vectors.
/// @param correction_limit  an enclosure in which an entry would change by more than this share is left raw
/// too: a defect far above the accuracy of the entries is no rounding to be spread out, but a wrong matrix.
/// Ten times the accuracy that was asked for is sensible.
/// @throws std::invalid_argument for shapes; Cancelled
ClosedOperator close_rows(ExchangeMatrix exchange_areas, std::vector<double> areas,
                          const Enclosures& enclosures, const Progress& progress = {},
                          double correction_limit = std::numeric_limits<double>::infinity());

/// A correction above this times the accuracy asked for is refused.
constexpr double most_correction = 10;

}  // namespace luxel
