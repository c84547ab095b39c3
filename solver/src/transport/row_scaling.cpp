#include "transport/row_scaling.h"

#include <algorithm>
#include <cmath>

#include "luxel/input_error.h"
#include "luxel/vector.h"
#include "ordered_sum.h"

namespace luxel {

namespace {

using Vector = Eigen::VectorXd;

// Of an enclosure's allowed row error: where scaling stops, so that what is left is surely below.
constexpr double stop_share = 0.1;

// Logarithm of the largest factor: a form factor off by 16 is no quadrature error, but a wrong matrix.
constexpr double largest_logarithm = 1.3862943611198906;

// Of the tolerance: what the last step may leave in its linear system, whose residual is a mean where the
// tolerance holds for every row.
constexpr double last_share = 0.1;

// Newton steps: 5 are usual, and each step of a doubtful problem that does not halve the error is one too
// many.
constexpr int most_steps = 40;

// Conjugate gradient steps inside one Newton step.
constexpr int most_inner_steps = 200;

Vector applied(const SymmetricProduct& product, const Vector& x) {
  Vector y(x.size());
  product(x.data(), y.data());
  return y;
}

/// Solves (diag(s) + D G D) x = b on the rows where mask is 1 to a relative residual. Source: Hestenes and
/// Stiefel 1952.
Vector newton_step(const SymmetricProduct& product, const Vector& d, const Vector& s, const Vector& mask,
                   const Vector& b, double relative) {
  const auto apply = [&](const Vector& p) -> Vector {
    const Vector scaled = d.cwiseProduct(p);
    return mask.cwiseProduct(s.cwiseProduct(p) + d.cwiseProduct(applied(product, scaled)));
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

/// Takes the enclosures that did worst out of `active`; gives a row of one of them.
int give_up_worst(const RowScaling& scaling, std::span<const int> enclosure, std::vector<char>& active) {
  const double worst = *std::max_element(scaling.errors.begin(), scaling.errors.end());
  std::vector<char> lost(*std::max_element(enclosure.begin(), enclosure.end()) + 1);
  int first = -1;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (!active[i] || !(scaling.errors[i] >= worst / 2)) continue;
    lost[enclosure[i]] = 1;
    if (first < 0) first = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (lost[enclosure[i]]) active[i] = 0;
  }
  return first;
}

}  // namespace

RowScaling scale_rows(const SymmetricProduct& product, std::span<const double> areas,
                      std::span<const char> active, double tolerance, const Progress& progress) {
  const auto size = static_cast<Eigen::Index>(areas.size());
  const Eigen::Map<const Vector> a(areas.data(), size);
  Vector mask(size);
  for (Eigen::Index i = 0; i < size; ++i) mask[i] = active[i] ? 1 : 0;

  Vector u = Vector::Zero(size), d = Vector::Ones(size);
  Vector s = applied(product, d);  // row sums of D G D
  const auto error_of = [&](const Vector& sums) -> Vector {
    return mask.cwiseProduct(sums.cwiseQuotient(a) - Vector::Ones(size)).cwiseAbs();
  };
  const auto potential = [&](const Vector& sums, const Vector& logarithms) {
    return 0.5 * ordered_sum({sums.data(), static_cast<std::size_t>(sums.size())}) -
           a.cwiseProduct(mask).dot(logarithms);
  };

  RowScaling result;
  double error = size == 0 ? 0 : error_of(s).maxCoeff();
  const double first_error = error;
  while (error > tolerance && result.iterations < most_steps) {
    ++result.iterations;
    const Vector gradient = mask.cwiseProduct(s - a);
    // solved as far as the quadratic step can use it, and no further than asked
    const double relative = std::clamp(std::max(error, last_share * tolerance / error), 1e-10, 0.05);
    const Vector positive = s.cwiseMax(1e-300);
    Vector step = newton_step(product, d, positive, mask, -gradient, relative);
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
      next_s = next_d.cwiseProduct(applied(product, next_d));
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

RowClosure close_enclosures(const SymmetricProduct& product, std::span<const double> areas,
                            std::span<const int> enclosure, std::vector<char> active, double within,
                            const Progress& progress) {
  RowClosure closure;
  closure.factors.assign(areas.size(), 1.0);
  while (std::find(active.begin(), active.end(), 1) != active.end()) {
    RowScaling scaling = scale_rows(product, areas, active, stop_share * within, progress);
    closure.iterations += scaling.iterations;
    if (*std::max_element(scaling.errors.begin(), scaling.errors.end()) <= within) {
      closure.factors = std::move(scaling.factors);
      break;
    }
    closure.unclosed = give_up_worst(scaling, enclosure, active);
  }
  closure.closed = std::move(active);
  return closure;
}

}  // namespace luxel
