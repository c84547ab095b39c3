#include "linear/factor/refinement.h"

#include <cmath>

namespace luxel {

namespace {

// The condition number is at most about 2 over the smallest loss. Float32 rounds at 6e-8, so that a step of
// refinement gains at least a factor of 10 for losses down to this, with room for the growth with N.
constexpr double loss_for_float32 = 1e-5;

// A step that gains less than this has met the rounding of its factor or of float64.
constexpr double least_gain = 0.5;

}  // namespace

FactorPrecision first_precision(const RadiositySystem& system) {
  double smallest_loss = 1;
  for (Eigen::Index c = 0; c < system.columns(); ++c) {
    const double returned = system.reflectance().col(c).cwiseProduct(system.row_sums()).maxCoeff();
    smallest_loss = std::min(smallest_loss, 1 - returned);
  }
  return smallest_loss >= loss_for_float32 ? FactorPrecision::float32 : FactorPrecision::float64;
}

PatchField refine(const RadiositySystem& system, PatchField radiosity, const Factorisation& factorise,
                  IterationWatch& watch) {
  PatchField residual = system.residual(radiosity);
  if (!watch.start(residual, radiosity)) return radiosity;
  FactorPrecision precision = first_precision(system);
  Correction correct = factorise(precision);
  while (true) {
    if (!correct && precision == FactorPrecision::float64) {
      watch.stop(Stopped::diverged,
                 "the system cannot be factored: the operator returns more light than it is given");
      return radiosity;
    }
    const double before = system.relative_norms(residual).maxCoeff();
    PatchField refined = radiosity;
    double after = std::numeric_limits<double>::infinity();
    if (correct) {
      refined += correct(residual);
      residual = system.residual(refined);
      after = system.relative_norms(residual).maxCoeff();
    }
    const bool poor = !(after < least_gain * before);
    if (poor && precision == FactorPrecision::float32) {
      if (after < before) radiosity = std::move(refined);
      residual = system.residual(radiosity);
      precision = FactorPrecision::float64;
      correct = nullptr;  // frees its memory first
      correct = factorise(precision);
      continue;
    }
    if (after <= before || watch.report().iterations == 0)
      radiosity = std::move(refined);
    else
      residual = system.residual(radiosity);
    if (!watch.next(residual, radiosity)) return radiosity;
    watch.report().refinements = watch.report().iterations - 1;
    if (poor && watch.report().iterations > 1) {
      watch.stop(Stopped::stagnated,
                 "refinement has met the rounding of float64 at this ratio of radiosity to emission");
      return radiosity;
    }
  }
}

}  // namespace luxel
