#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>

#include "luxel/solve.h"
#include "solver/matrix_operator.h"

namespace luxel::test {

inline constexpr Method all_methods[] = {Method::cholesky,
                                         Method::lu,
                                         Method::cg,
                                         Method::gmres,
                                         Method::neumann,
                                         Method::gauss_seidel,
                                         Method::symmetric_gauss_seidel,
                                         Method::southwell};

/// The method's name as a test's name.
inline std::string test_name(Method method) {
  std::string word(name(method));
  std::replace(word.begin(), word.end(), '-', '_');
  return word;
}

inline PatchField column(std::initializer_list<double> values) {
  PatchField field(values.size(), 1);
  std::copy(values.begin(), values.end(), field.data());
  return field;
}

/// Reflectances in [low, high], and emissions in [0, 1] of every tenth patch.
inline std::pair<PatchField, PatchField> random_scene(int n, int m, double low, double high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  PatchField reflectance(n, m), emission(n, m);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < m; ++c) {
      reflectance(i, c) = low + (high - low) * uniform(random);
      emission(i, c) = i % 10 == 0 ? uniform(random) : 0;
    }
  }
  return {reflectance, emission};
}

/// B by Gaussian elimination in long double.
inline PatchField exact(const MatrixOperator& transport, const PatchField& reflectance,
                        const PatchField& emission) {
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  PatchField radiosity(emission.rows(), emission.cols());
  for (Eigen::Index c = 0; c < emission.cols(); ++c) {
    const Wide k = reflectance.col(c).cast<long double>().asDiagonal() * transport.rows().cast<long double>();
    const Wide system = Wide::Identity(k.rows(), k.cols()) - k;
    radiosity.col(c) = system.partialPivLu().solve(Wide(emission.col(c).cast<long double>())).cast<double>();
  }
  return radiosity;
}

/// max |B - B*| / max |B*|, worst channel.
inline double largest_error(const PatchField& radiosity, const PatchField& expected) {
  double worst = 0;
  for (Eigen::Index c = 0; c < expected.cols(); ++c) {
    const double largest = expected.col(c).cwiseAbs().maxCoeff();
    if (largest > 0) worst = std::max(worst, (radiosity - expected).col(c).cwiseAbs().maxCoeff() / largest);
  }
  return worst;
}

}  // namespace luxel::test
