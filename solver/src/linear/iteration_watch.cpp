#include "linear/iteration_watch.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "linear/columns.h"

namespace luxel {

namespace {

// Light that is reflected with rho s <= 1 never gains in any norm; operators with a few rows above 1 may gain
// for two or three bounces before they settle.
constexpr int rises_of_divergence = 5;

// A residual this far above the best one has left it for good; conjugate gradients oscillate by less.
constexpr double growth_of_divergence = 1e6;

// Conjugate gradients stay within a few dozen iterations of their best residual as long as they get on.
constexpr int window_of_stagnation = 50;

// The residual of a B rounded to float64 stays above about u ||B|| / ||E||.
constexpr double rounding_floor = 0x1p-53;

}  // namespace

IterationWatch::IterationWatch(const RadiositySystem& system, const SolveOptions& options,
                               const ErrorBound* bound, SolveReport& report)
    : system_(&system), options_(&options), bound_(bound), report_(&report) {}

double IterationWatch::bound_of(const PatchField& residual, const PatchField& radiosity) const {
  return bound_ ? bound_->relative(residual, radiosity) : std::numeric_limits<double>::infinity();
}

bool IterationWatch::holds(const Iteration& iteration, double margin) const {
  if (bound_ && options_->error) return iteration.error_bound <= margin * *options_->error;
  return iteration.relative_residual <= margin * options_->tolerance;
}

bool IterationWatch::satisfied(const PatchField& residual, const PatchField& radiosity) const {
  Iteration iteration;
  iteration.relative_residual = system_->relative_norms(residual).maxCoeff();
  iteration.error_bound = bound_of(residual, radiosity);
  return holds(iteration, 1);
}

double IterationWatch::target() const {
  if (!bound_ || !options_->error || report_->history.empty()) return margin_ * options_->tolerance;
  const Iteration* last = nullptr;
  for (const Iteration& past : report_->history) {
    if (std::isfinite(past.error_bound) && past.error_bound > 0) last = &past;
  }
  // the bound is nearly proportional to the residual; half of it, so that one more cycle suffices
  return last ? 0.5 * margin_ * last->relative_residual * *options_->error / last->error_bound : 0;
}

bool IterationWatch::start(const PatchField& residual, const PatchField& radiosity) {
  Iteration iteration;
  iteration.number = report_->iterations;
  iteration.relative_residual = system_->relative_norms(residual).maxCoeff();
  iteration.error_bound = bound_of(residual, radiosity);
  iteration.radiosity = &radiosity;
  if (iteration.number > 0) return !holds(iteration, margin_);
  if (!record(iteration)) return false;
  // One bounce at least: light from a tiny emitter may be below any tolerance relative to ||E|| and is not
  // lost.
  return residual.cwiseAbs().maxCoeff() > 0 || stop(Stopped::converged, {});
}

bool IterationWatch::next(const PatchField& residual, const PatchField& radiosity) {
  Iteration iteration;
  iteration.number = ++report_->iterations;
  iteration.relative_residual = system_->relative_norms(residual).maxCoeff();
  iteration.error_bound = bound_of(residual, radiosity);
  iteration.radiosity = &radiosity;
  return record(iteration) && progress(iteration);
}

bool IterationWatch::next(const Eigen::RowVectorXd& relative_norms) {
  Iteration iteration;
  iteration.number = ++report_->iterations;
  iteration.relative_residual = relative_norms.maxCoeff();
  return record(iteration) && progress(iteration);
}

bool IterationWatch::record(Iteration iteration) {
  report_->history.push_back(iteration);
  report_->history.back().radiosity = nullptr;
  if (!options_->on_iteration || options_->on_iteration(iteration)) return true;
  return stop(Stopped::caller, "stopped by the caller at iteration " + std::to_string(iteration.number));
}

bool IterationWatch::stop(Stopped reason, std::string message) {
  report_->stopped = reason;
  report_->message = std::move(message);
  return false;
}

bool IterationWatch::progress(const Iteration& iteration) {
  const double residual = iteration.relative_residual;
  const std::string at = " at iteration " + std::to_string(iteration.number);
  if (!std::isfinite(residual)) {
    return stop(Stopped::diverged, "the residual is not a number" + at);
  }
  if (holds(iteration, margin_)) return stop(Stopped::converged, {});
  rises_ = residual > previous_ ? rises_ + 1 : 0;
  previous_ = residual;
  if (residual < best_) {
    best_ = residual;
    since_best_ = 0;
  } else {
    ++since_best_;
  }
  double floor = 0;
  if (rises_ >= rises_of_divergence || since_best_ >= window_of_stagnation) {
    const PatchField* radiosity = iteration.radiosity;
    if (radiosity) floor = rounding_floor * system_->relative_norms(*radiosity).maxCoeff();
  }
  const bool above_rounding = residual > 100 * floor;
  const bool keeps_rising = expects_decrease_ && rises_ >= rises_of_divergence && above_rounding;
  if (keeps_rising || residual > growth_of_divergence * best_) {
    const double gain =
        system_->reflectance().cwiseProduct(system_->row_sums().replicate(1, system_->columns())).maxCoeff();
    std::ostringstream why;
    why << "diverges: the residual has grown" << at;
    if (gain > 1) why << "; a row of the operator times its reflectance reaches " << gain;
    return stop(Stopped::diverged, why.str());
  }
  if (since_best_ >= window_of_stagnation) {
    std::ostringstream why;
    why << "no progress below a relative residual of " << best_ << " over " << window_of_stagnation
        << " iterations" << at;
    if (!above_rounding) why << "; this is the rounding of float64 at this ratio of radiosity to emission";
    return stop(Stopped::stagnated, why.str());
  }
  if (iteration.number >= options_->max_iterations) {
    return stop(Stopped::iterations,
                "not converged within " + std::to_string(iteration.number) + " iterations");
  }
  return true;
}

}  // namespace luxel
