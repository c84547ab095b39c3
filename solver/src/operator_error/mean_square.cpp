#include "operator_error/mean_square.h"

#include <algorithm>
#include <cmath>

namespace luxel {

MeanSquare::MeanSquare(const std::vector<StratumDefects>& defects, const PatchField& reflectance,
                       const CoarseExchange& coarse, const std::vector<double>& mean_reflectance,
                       Eigen::Index channel)
    : defects_(defects), reflectance_(reflectance), coarse_(coarse), channel_(channel) {
  const auto parts = static_cast<Eigen::Index>(coarse.areas.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(parts, parts);
  for (Eigen::Index j = 0; j < parts; ++j) system.col(j) -= coarse.form_factors.col(j) * mean_reflectance[j];
  solver_.compute(system);
}

double MeanSquare::operator()(int left_out) const {
  const auto parts = static_cast<Eigen::Index>(coarse_.areas.size());
  const int strata = static_cast<int>(defects_.size());
  const auto part = [&](int s) { return static_cast<Eigen::Index>(s) * parts / strata; };
  Eigen::MatrixXd source = Eigen::MatrixXd::Zero(parts, batches);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(parts, batches);
  for (int s = 0; s < strata; ++s) {
    if (s % groups == left_out) continue;
    for (int b = 0; b < batches; ++b) {
      const Defect& defect = defects_[s][b];
      weights(part(s), b) += defect.weight;
      source(part(s), b) += defect.weight * reflectance_(defect.patch, channel_) * defect.mean()[channel_];
    }
  }
  source = (weights.array() > 0).select(source.cwiseQuotient(weights), 0.0).eval();
  const Eigen::MatrixXd carried = solver_.solve(coarse_.form_factors * source);
  double sum = 0, whole = 0;
  for (int s = 0; s < strata; ++s) {
    if (s % groups == left_out) continue;
    for (int b = 0; b < batches; ++b) {
      const Defect& defect = defects_[s][b];
      const double first = defect.halves[0][channel_], second = defect.halves[1][channel_];
      const double x = carried(part(s), (b + 1) % batches), y = carried(part(s), (b + 2) % batches);
      sum += defect.weight * ((first + x) * (second + y) + (first + y) * (second + x)) / 2;
      whole += defect.weight;
    }
  }
  return sum / whole;
}

double MeanSquare::noise_of_look() const {
  double sum = 0, whole = 0;
  for (const StratumDefects& of_stratum : defects_) {
    for (const Defect& defect : of_stratum) {
      const double difference = defect.halves[0][channel_] - defect.halves[1][channel_];
      sum += defect.weight * difference * difference / 2;
      whole += defect.weight;
    }
  }
  return sum / whole;
}

// The halves differ by twice the noise variance of one, whose product with the other's varies by its square:
// a fourth power of normal differences is three times the square of their variance.
double MeanSquare::noise() const {
  double sum = 0, whole = 0;
  for (const StratumDefects& of_stratum : defects_) {
    for (const Defect& defect : of_stratum) {
      const double difference = defect.halves[0][channel_] - defect.halves[1][channel_];
      const double product = defect.weight * difference * difference;
      sum += product * product / 12;
      whole += defect.weight;
    }
  }
  return std::sqrt(sum) / whole;
}

}  // namespace luxel
