#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "luxel/dense_operator.h"
#include "transport/row_scaling.h"
#include "transport/symmetric_product.h"

namespace luxel {

namespace {

// Row error that a scaled enclosure may keep; what is left then is rounding and goes to the diagonal.
constexpr double closed_within = 1e-12;

/// Rounds a number >= 0 towards 0, so that rows never sum to more than in float64: what is missing fits a
/// diagonal >= 0. Of IEEE numbers above 0 the next smaller one has the bits of the integer before.
template <class Real>
Real rounded_down(double value) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  const Real nearest = static_cast<Real>(value);
  return std::bit_cast<Real>(std::bit_cast<Bits>(nearest) - static_cast<Bits>(nearest > value));
}

// Maxima that are kept side by side, so that the compiler can take entries eight at a time.
constexpr int side_by_side = 8;

/// Entries of one row by d_i d_j, never above what either patch can send; the largest |d_i d_j - 1| of an
/// entry other than 0.
template <class Real>
double scale_row(Real* row, int count, double area, const double* areas, double factor,
                 const double* factors) {
  std::array<double, side_by_side> largest{};
  const auto scale = [&](int j, int lane) {
    const double both = factor * factors[j];
    const double old = row[j];
    const double change = old == 0 ? 0 : std::abs(both - 1);
    largest[lane] = change > largest[lane] ? change : largest[lane];
    const double smaller = area < areas[j] ? area : areas[j], scaled = old * both;
    const double bounded = scaled < smaller ? scaled : smaller;
    row[j] = rounded_down<Real>(change == 0 ? old : bounded);
  };
  int j = 0;
  for (; j + side_by_side <= count; j += side_by_side) {
    for (int lane = 0; lane < side_by_side; ++lane) scale(j + lane, lane);
  }
  for (; j < count; ++j) scale(j, 0);
  return *std::max_element(largest.begin(), largest.end());
}

/// G_ij <- d_i d_j G_ij; the largest |d_i d_j - 1| of an entry.
template <class Real>
double scale_entries(ExchangeMatrix& matrix, const std::vector<double>& areas, const std::vector<double>& d) {
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, matrix.size(), 64), 0.0,
      [&](const tbb::blocked_range<int>& range, double largest) {
        for (int i = range.begin(); i < range.end(); ++i) {
          largest =
              std::max(largest, scale_row(matrix.row<Real>(i), i, areas[i], areas.data(), d[i], d.data()));
        }
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

double scale_entries(ExchangeMatrix& matrix, const std::vector<double>& areas, const std::vector<double>& d) {
  return matrix.precision() == Precision::float32 ? scale_entries<float>(matrix, areas, d)
                                                  : scale_entries<double>(matrix, areas, d);
}

/// The largest |d_i d_j - 1| of an entry other than 0 in each enclosure.
template <class Real>
std::vector<double> corrections(const ExchangeMatrix& matrix, const std::vector<double>& d,
                                const Enclosures& enclosures) {
  std::vector<double> largest(static_cast<std::size_t>(enclosures.count));
  for (int i = 0; i < matrix.size(); ++i) {
    double& found = largest[enclosures.enclosure[i]];
    const Real* row = matrix.row<Real>(i);
    for (int j = 0; j < i; ++j) {
      if (row[j] != 0) found = std::max(found, std::abs(d[i] * d[j] - 1));
    }
  }
  return largest;
}

/// Takes enclosures whose correction is above the limit out of `active` and sets their factors to 1.
void refuse(const ExchangeMatrix& matrix, const Enclosures& enclosures, double limit, std::vector<double>& d,
            std::vector<char>& active, ClosureReport& report) {
  // no entry is changed by more than the square of a factor
  const bool none = std::all_of(d.begin(), d.end(), [&](double f) { return std::abs(f * f - 1) <= limit; });
  if (none) return;
  const std::vector<double> found = matrix.precision() == Precision::float32
                                        ? corrections<float>(matrix, d, enclosures)
                                        : corrections<double>(matrix, d, enclosures);
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double correction = found[enclosures.enclosure[i]];
    if (!active[i] || !(correction > limit)) continue;
    active[i] = 0;
    d[i] = 1;
    if (correction > report.refused_correction) {
      report.refused_correction = correction;
      report.unclosed = static_cast<int>(i);
      report.message = refused_message(report.unclosed, correction, limit);
    }
  }
}

}  // namespace

std::vector<double> row_sums(const ExchangeMatrix& exchange_areas, std::span<const double> areas) {
  const std::vector<double> ones(areas.size(), 1.0);
  std::vector<double> sums(areas.size());
  symmetric_product(exchange_areas, ones.data(), sums.data(), 1);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= areas[i];
  return sums;
}

std::string unclosed_message(int patch) {
  return "the rows of the enclosure of patch " + std::to_string(patch) +
         " cannot be closed by factors within [1/4, 4] and were left as they are";
}

std::string refused_message(int patch, double correction, double limit) {
  std::ostringstream message;
  message
      << "the rows of the enclosure of patch " << patch << " would be closed by changing factors by up to "
      << std::setprecision(2) << correction << ", above " << limit
      << ": they were left as they are; the surfaces may cover each other or have gaps (see luxel inspect)";
  return message.str();
}

RowSumError row_sum_error(std::span<const double> row_sums, std::span<const double> areas,
                          const Enclosures& enclosures) {
  RowSumError error;
  double squares = 0, noise = 0, total = 0;
  for (std::size_t i = 0; i < row_sums.size(); ++i) {
    const double off = std::abs(row_sums[i] + enclosures.open_share[i] + enclosures.back_share[i] - 1);
    error.max = std::max(error.max, off);
    error.max_beyond_sampling = std::max(error.max_beyond_sampling, off - 3 * enclosures.share_error[i]);
    squares += areas[i] * off * off;
    noise += areas[i] * enclosures.share_error[i] * enclosures.share_error[i];
    total += areas[i];
  }
  if (total > 0) {
    error.rms = std::sqrt(squares / total);
    error.sampling_rms = std::sqrt(noise / total);
  }
  return error;
}

ClosedOperator close_rows(ExchangeMatrix exchange_areas, std::vector<double> areas,
                          const Enclosures& enclosures, const Progress& progress, double correction_limit) {
  const std::size_t size = exchange_areas.size();
  if (areas.size() != size || enclosures.enclosure.size() != size) {
    throw std::invalid_argument("close_rows: areas and enclosures need one entry for each patch");
  }
  ClosureReport report;
  std::vector<double> sums = row_sums(exchange_areas, areas);
  report.before = row_sum_error(sums, areas, enclosures);

  // rows of closed enclosures; one that sees nobody has nothing to scale
  std::vector<char> active(size);
  for (std::size_t i = 0; i < size; ++i) {
    active[i] = enclosures.enclosure_closed[enclosures.enclosure[i]] && sums[i] > 0;
  }
  const SymmetricProduct product = [&](const double* x, double* y) {
    symmetric_product(exchange_areas, x, y, 1);
  };
  std::vector<double> diagonal(size, 0.0);
  RowClosure closure =
      close_enclosures(product, areas, enclosures.enclosure, std::move(active), closed_within, progress);
  report.iterations = closure.iterations;
  report.unclosed = closure.unclosed;
  if (closure.unclosed >= 0) report.message = unclosed_message(closure.unclosed);
  refuse(exchange_areas, enclosures, correction_limit, closure.factors, closure.closed, report);
  if (std::find(closure.closed.begin(), closure.closed.end(), 1) != closure.closed.end()) {
    report.applied = true;
    report.largest_correction = scale_entries(exchange_areas, areas, closure.factors);
    sums = row_sums(exchange_areas, areas);
    for (std::size_t i = 0; i < size; ++i) {
      if (closure.closed[i]) diagonal[i] = std::max(0.0, areas[i] - sums[i] * areas[i]);
    }
  }
  auto transport =
      std::make_unique<DenseOperator>(std::move(exchange_areas), std::move(areas), std::move(diagonal));
  report.after = row_sum_error(transport->row_sums(), transport->areas(), enclosures);
  return {std::move(transport), report};
}

}  // namespace luxel
