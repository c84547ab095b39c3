#include "transport/row_scaling.h"

#include <algorithm>
#include <cmath>

#include "luxel/input_error.h"
#include "luxel/vector.h"
#include "transport/symmetric_product.h"

namespace luxel {

namespace {

using Vector = Eigen::VectorXd;

// Relative row error to stop at: an order above what summing a million products in float64 rounds.
constexpr double tolerance = 1e-13;

// Logarithm of the largest factor: a form factor off by 16 is no quadrature error, but a wrong matrix.
constexpr double largest_logarithm = 1.3862943611198906;

// Newton steps: 5 are usual, and each step of a doubtful problem that does not halve the error is one too
// many.
constexpr int most_steps = 40;

// Conjugate gradient steps inside one Newton step.
constexpr int most_inner_steps = 200;

Vector product(const ExchangeMatrix& matrix, const Vector& x) {
  Vector y(x.size());
  symmetric_product(matrix, x.data(), y.data(), 1);
  return y;
}

/// Solves (diag(s) + D G D) x = b on the rows where mask is 1 to a relative residual. Source: Hestenes and
/// Stiefel 1952.
Vector newton_step(const ExchangeMatrix& matrix, const Vector& d, const Vector& s, const Vector& mask,
                   const Vector& b, double relative) {
  const auto apply = [&](const Vector& p) -> Vector {
    const Vector scaled = d.cwiseProduct(p);
    return mask.cwiseProduct(s.cwiseProduct(p) + d.cwiseProduct(product(matrix, scaled)));
  };
  Vector x = Vector::Zero(b.size());
  Vector r = b;
  Vector z = r.cwiseQuotient(s);
  Vector p = z;
  double rho = r.dot(z);
  const double goal = relative * relative * rho;
  for (int step = 0; step < most_inner_steps && rho > goal; ++step) {
    const Vector q = apply(p);
    const double curvature = p.dot(q);
    if (!(curvature > 0)) break;  // a bipartite enclosure is singular; what is found so far will do
    const double alpha = rho / curvature;
    x += alpha * p;
    r -= alpha * q;
    z = r.cwiseQuotient(s);
    const double next = r.dot(z);
    p = z + next / rho * p;
    rho = next;
  }
  return x;
}

}  // namespace

RowScaling scale_rows(const ExchangeMatrix& matrix, std::span<const double> areas,
                      std::span<const char> active, const Progress& progress) {
  const Eigen::Index size = matrix.size();
  const Eigen::Map<const Vector> a(areas.data(), size);
  Vector mask(size);
  for (Eigen::Index i = 0; i < size; ++i) mask[i] = active[i] ? 1 : 0;

  Vector u = Vector::Zero(size), d = Vector::Ones(size);
  Vector s = product(matrix, d);  // row sums of D G D
  const auto error_of = [&](const Vector& sums) -> Vector {
    return mask.cwiseProduct(sums.cwiseQuotient(a) - Vector::Ones(size)).cwiseAbs();
  };
  const auto potential = [&](const Vector& sums, const Vector& logarithms) {
    return 0.5 * sums.sum() - a.cwiseProduct(mask).dot(logarithms);
  };

  RowScaling result;
  double error = size == 0 ? 0 : error_of(s).maxCoeff();
  const double first_error = error;
  while (error > tolerance && result.iterations < most_steps) {
    ++result.iterations;
    const Vector gradient = mask.cwiseProduct(s - a);
    // solved as far as the quadratic step can use it
    const Vector positive = s.cwiseMax(1e-300);
    Vector step = newton_step(matrix, d, positive, mask, -gradient, std::clamp(0.1 * error, 1e-10, 0.05));
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > 1) step /= longest;

    // half steps until the convex function falls (Armijo); at rounding the gradient decides
    const double before = potential(s, u), slope = gradient.dot(step);
    double fraction = 1;
    Vector next_u, next_d, next_s;
    double next_error = 0;
    bool better = false;
    for (int halving = 0; halving < 10 && !better; ++halving, fraction /= 2) {
      next_u = u + fraction * step;
      next_d = next_u.array().exp();
      next_s = next_d.cwiseProduct(product(matrix, next_d));
      next_error = error_of(next_s).maxCoeff();
      better = next_error < 0.5 * error || potential(next_s, next_u) <= before + 1e-4 * fraction * slope;
    }
    if (!better || !std::isfinite(next_error) || next_u.cwiseAbs().maxCoeff() > largest_logarithm) break;
    const bool at_rounding = next_error < 10 * tolerance && next_error > 0.5 * error;
    u = next_u;
    d = next_d;
    s = next_s;
    error = next_error;
    if (progress && error > 0) {
      const double total = std::log(first_error / tolerance);
      if (!progress("closure", std::min(std::log(first_error / error), total), total)) throw Cancelled();
    }
    if (at_rounding) break;
  }
  const Vector errors = error_of(s);
  result.converged = error <= 10 * tolerance;
  result.factors.assign(d.data(), d.data() + size);
  result.errors.assign(errors.data(), errors.data() + size);
  return result;
}

}  // namespace luxel
