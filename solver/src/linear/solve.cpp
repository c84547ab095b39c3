#include "luxel/solve.h"

#include <algorithm>
#include <string>
#include <utility>

#include "linear/methods.h"
#include "linear/singular.h"
#include "luxel/exchange_matrix.h"
#include "ordered_sum.h"
#include "plan/cost_model.h"

namespace luxel {

namespace {

// A residual from a recurrence differs from the true one by rounding only, which one or two fresh starts
// repair.
constexpr int fresh_starts = 4;

// Rounding and the residual asked may leave a B that should be 0 this far below it, as a share of the largest
// B.
constexpr double rounding_of_radiosity = 1e-6;

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("solve: " + message);
}

void check(const TransportOperator& transport, const PatchField& reflectance, const PatchField& emission,
           const SolveOptions& options) {
  const auto shape = [&](const PatchField& field) {
    return std::to_string(field.rows()) + " x " + std::to_string(field.cols());
  };
  require(reflectance.rows() == transport.size() && emission.rows() == transport.size() &&
              reflectance.cols() == emission.cols(),
          "reflectance is " + shape(reflectance) + " and emission " + shape(emission) + " for " +
              std::to_string(transport.size()) + " patches");
  require((reflectance.array() >= 0 && reflectance.array() <= 1).all(), "reflectance must lie in [0, 1]");
  require((emission.array() >= 0).all() && emission.allFinite(), "emission must be finite and not negative");
  require(options.tolerance > 0, "tolerance must be positive");
  require(!options.error || *options.error > 0, "error must be positive");
  require(options.max_iterations >= 1, "max_iterations must be 1 or more");
  require(options.restart >= 1, "restart must be 1 or more");
  require(!options.bounces || *options.bounces >= 0, "bounces must be 0 or more");
}

SolveShape shape(const RadiositySystem& system, const SolveOptions& options) {
  SolveShape shape;
  shape.patches = static_cast<double>(system.size());
  const Eigen::RowVectorXd mean =
      system.areas().transpose() * system.reflectance() /
      ordered_sum({system.areas().data(), static_cast<std::size_t>(system.areas().size())});
  for (const auto& group : system.groups_of_equal_reflectance()) {
    shape.columns.push_back(static_cast<int>(group.size()));
    shape.mean_reflectance = std::max(shape.mean_reflectance, mean[group.front()]);
  }
  if (system.reflectance().size() > 0) shape.largest_reflectance = system.reflectance().maxCoeff();
  shape.tolerance = std::min(options.error.value_or(options.tolerance), 0.5);
  const ExchangeMatrix* entries = system.transport().entries();
  shape.entries = entries != nullptr;
  if (entries) shape.precision = entries->precision();
  return shape;
}

Method choose(const RadiositySystem& system, const SolveOptions& options) {
  if (options.bounces) return Method::neumann;
  if (!system.transport().symmetric()) return Method::gmres;
  return cheapest_method(shape(system, options));
}

void check_method(Method method, const TransportOperator& transport, const SolveOptions& options) {
  const std::string word(name(method));
  const bool on_symmetric = method == Method::cg || method == Method::cholesky;
  require(!on_symmetric || transport.symmetric(), word + " needs a symmetric operator; gmres does not");
  const bool on_entries = method == Method::cholesky || method == Method::lu ||
                          method == Method::gauss_seidel || method == Method::symmetric_gauss_seidel ||
                          method == Method::southwell;
  require(!on_entries || transport.entries(), word + " needs an operator with entries, such as dense");
  require(!options.bounces || method == Method::neumann, "bounces are for neumann, not for " + word);
}

PatchField run(const RadiositySystem& system, PatchField start, const SolveOptions& options, Method method,
               IterationWatch& watch) {
  switch (method) {
    case Method::cholesky:
      return cholesky(system, std::move(start), watch);
    case Method::lu:
      return lu(system, std::move(start), watch);
    case Method::gmres:
      return gmres(system, std::move(start), options.restart, watch);
    case Method::neumann:
      return options.bounces ? neumann_bounces(system, *options.bounces, watch)
                             : neumann(system, std::move(start), watch);
    case Method::gauss_seidel:
      return gauss_seidel(system, std::move(start), false, watch);
    case Method::symmetric_gauss_seidel:
      return gauss_seidel(system, std::move(start), true, watch);
    case Method::southwell:
      return southwell(system, std::move(start), watch);
    default:
      return cg(system, std::move(start), watch);
  }
}

// With F >= 0 and a series that converges, B >= E >= 0. A negative B therefore proves that the series
// diverges, and that what solves the equations is no light.
bool unphysical(const PatchField& radiosity) {
  return radiosity.minCoeff() < -rounding_of_radiosity * radiosity.cwiseAbs().maxCoeff();
}

}  // namespace

RadiositySolution solve(const TransportOperator& transport, const PatchField& reflectance,
                        const PatchField& emission, const SolveOptions& options) {
  check(transport, reflectance, emission, options);
  const RadiositySystem system(transport, reflectance, emission);
  const Method method = options.method == Method::automatic ? choose(system, options) : options.method;
  check_method(method, transport, options);
  // a number of bounces is defined whether or not their sum is
  if (!options.bounces) refuse_singular(system);

  RadiositySolution solution;
  SolveReport& report = solution.report;
  report.method = method;
  solution.radiosity = emission;
  solution.irradiance = PatchField::Zero(emission.rows(), emission.cols());
  if (emission.size() == 0 || emission.maxCoeff() == 0) {
    report.converged = true;
    report.error_bound = 0;
    return solution;
  }

  ErrorBound bound(system);
  if (bound.worth_sharpening()) bound.sharpen();
  IterationWatch watch(system, options, &bound, report);
  for (int start = 0; start <= fresh_starts; ++start) {
    solution.radiosity = run(system, std::move(solution.radiosity), options, method, watch);
    Balance balance = system.balance(solution.radiosity);
    solution.irradiance = std::move(balance.irradiance);
    const PatchField& residual = balance.residual;
    report.relative_residual = system.relative_norms(residual).maxCoeff();
    report.error_bound = bound.relative(residual, solution.radiosity);
    report.converged = watch.satisfied(residual, solution.radiosity);
    if (report.converged || report.stopped != Stopped::converged) break;
    watch.tighten();
  }
  if (!report.converged && report.stopped == Stopped::converged) {
    watch.stop(Stopped::stagnated, "the residual measured anew stays above what was asked, at rounding");
  }
  if (report.converged && report.stopped != Stopped::bounces && report.stopped != Stopped::caller) {
    watch.stop(Stopped::converged, {});
  }
  if (!bound.exists() && report.converged && !options.bounces && unphysical(solution.radiosity)) {
    report.converged = false;
    watch.stop(Stopped::diverged,
               "the equations are solved by negative radiosities only: the operator returns more light than "
               "it is given");
  }
  if (!bound.exists()) {
    if (!report.message.empty()) report.message += "; ";
    report.message +=
        "no error bound: some row of the operator times its reflectance reaches 1, and no test "
        "vector proves the series to converge";
  }
  return solution;
}

}  // namespace luxel
