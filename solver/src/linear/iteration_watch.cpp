#include "linear/iteration_watch.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "linear/columns.h"

namespace luxel {

namespace {

// Light reflected with rho s <= 1 never gains power; operators with a few rows above 1 may gain
// for two or three bounces before they settle.
constexpr int rises_of_divergence = 5;

// A residual this far above the best one has left it for good; conjugate gradients oscillate by less.
constexpr double growth_of_divergence = 1e6;

// Conjugate gradients stay within a few dozen iterations of their best residual as long as they get on.
constexpr int window_of_stagnation = 50;

// A residual, or the power left in it, that has fallen so many times in a row gets on, however slowly and
// however high a hump it had to climb at first (Gauss-Seidel near reflectance 1); the noise of rounding falls
// as often by chance once in 2^25 iterations.
constexpr int falls_of_progress = 25;

// The residual of a B rounded to float64 stays above about u ||B||; within a hundred times that, sums of many
// numbers may rise and fall at will.
constexpr double unit_roundoff = 0x1p-53;
constexpr double room_above_rounding = 100;

/// sum A_i |x_i| of each column.
Eigen::RowVectorXd area_sums(const Eigen::VectorXd& areas, const PatchField& x) {
  return sum_over_rows(x.rows(), x.cols(), [&](Eigen::Index first, Eigen::Index count) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(x.cols());
    for (Eigen::Index i = first; i < first + count; ++i) sum += areas[i] * x.row(i).cwiseAbs();
    return sum;
  });
}

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
  // the power on its way: shooting lowers it at every step, while the norm may rise where it gathers
  count_falls(area_sums(system_->areas(), residual).maxCoeff());
  if (!record(iteration) || !progress(iteration)) return false;
  if (!expects_decrease_ || !power_rises(residual, radiosity)) return true;
  return stop(Stopped::diverged,
              "diverges: the light on its way has grown over " + std::to_string(rises_of_divergence) +
                  " iterations in a row, at iteration " + std::to_string(iteration.number) + row_gain());
}

bool IterationWatch::next(const Eigen::RowVectorXd& relative_norms) {
  Iteration iteration;
  iteration.number = ++report_->iterations;
  iteration.relative_residual = relative_norms.maxCoeff();
  count_falls(iteration.relative_residual);
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

std::string IterationWatch::row_gain() const {
  const auto returned =
      system_->reflectance().cwiseProduct(system_->row_sums().replicate(1, system_->columns()));
  const double gain = returned.maxCoeff();
  // rows that rounding has left just above 1 explain nothing
  if (gain < 1 + 1e-9) return {};
  std::ostringstream text;
  text << "; a row sum of the operator times its reflectance reaches " << gain;
  return text.str();
}

bool IterationWatch::power_rises(const PatchField& residual, const PatchField& radiosity) {
  const Eigen::RowVectorXd power = area_sums(system_->areas(), residual);
  if (power_.size() == 0) {
    rises_.setZero(power.size());
  } else {
    rises_ = (power.array() > power_.array()).select(rises_.array() + 1, 0);
  }
  power_ = power;
  if (rises_.maxCoeff() < rises_of_divergence) return false;
  const Eigen::RowVectorXd floor =
      room_above_rounding * unit_roundoff * area_sums(system_->areas(), radiosity);
  return (rises_.array() >= rises_of_divergence && power.array() > floor.array()).any();
}

void IterationWatch::count_falls(double measure) {
  falls_ = measure < last_ ? falls_ + 1 : 0;
  last_ = measure;
}

bool IterationWatch::progress(const Iteration& iteration) {
  const double residual = iteration.relative_residual;
  const std::string at = " at iteration " + std::to_string(iteration.number);
  if (!std::isfinite(residual))
    return stop(Stopped::diverged, "the residual is not a number" + at + row_gain());
  if (holds(iteration, margin_)) return stop(Stopped::converged, {});
  if (residual > growth_of_divergence * best_) {
    return stop(Stopped::diverged, "diverges: the residual has grown a million times" + at + row_gain());
  }
  since_best_ = residual < best_ ? 0 : since_best_ + 1;
  best_ = std::min(best_, residual);
  if (since_best_ >= window_of_stagnation && falls_ < falls_of_progress) {
    std::ostringstream why;
    why << "no progress over " << window_of_stagnation << " iterations" << at
        << ", below a relative residual of " << best_;
    if (iteration.radiosity) {
      const double floor = unit_roundoff * system_->relative_norms(*iteration.radiosity).maxCoeff();
      if (best_ < room_above_rounding * floor)
        why << ": the rounding of float64 at this ratio of radiosity to emission";
    }
    return stop(Stopped::stagnated, why.str());
  }
  if (iteration.number >= options_->max_iterations) {
    return stop(Stopped::iterations,
                "not converged within " + std::to_string(iteration.number) + " iterations");
  }
  return true;
}

}  // namespace luxel
