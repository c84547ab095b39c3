#include "luxel/solve.h"

#include <gtest/gtest.h>

#include "solver/matrix_operator.h"

namespace luxel {
namespace {

using test::cube6;
using test::MatrixOperator;

constexpr Method all_methods[] = {Method::cholesky,
                                  Method::lu,
                                  Method::cg,
                                  Method::gmres,
                                  Method::neumann,
                                  Method::gauss_seidel,
                                  Method::symmetric_gauss_seidel,
                                  Method::southwell};

class EveryMethod : public testing::TestWithParam<Method> {
 protected:
  SolveOptions options(double tolerance) const {
    SolveOptions options;
    options.method = GetParam();
    options.tolerance = tolerance;
    options.max_iterations = 100'000;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Solve, EveryMethod, testing::ValuesIn(all_methods), [](const auto& method) {
  std::string word(name(method.param));
  std::replace(word.begin(), word.end(), '-', '_');
  return word;
});

TEST_P(EveryMethod, SolvesTheWhiteFurnace) {
  const auto transport = test::random_enclosure(60, 1);
  for (const double rho : {0.5, 0.9, 0.999}) {
    const PatchField reflectance = PatchField::Constant(60, 3, rho);
    const PatchField emission = PatchField::Constant(60, 3, 2);

    const auto solution = solve(transport, reflectance, emission, options(1e-12));

    EXPECT_TRUE(solution.report.converged) << rho << ": " << solution.report.message;
    // the row sums are 1 to 1e-15, which 1 / (1 - rho) magnifies; the residual adds 1e-12 / (1 - rho)
    const double tolerance = 4e-12 / (1 - rho);
    EXPECT_LT((solution.radiosity.array() * (1 - rho) / 2 - 1).abs().maxCoeff(), tolerance) << rho;
    EXPECT_LE(solution.report.relative_residual, 1e-12);
  }
}

}  // namespace
}  // namespace luxel
