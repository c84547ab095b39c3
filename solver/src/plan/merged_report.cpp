#include "plan/merged_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace luxel {

MergedReport::MergedReport(const PatchMesh& mesh, const PatchField& emission, const SolveOptions& options)
    : mesh_(mesh), emission_(emission) {
  report_.method = options.bounces ? Method::neumann : options.method;
  if (report_.method == Method::automatic) report_.method = Method::cg;
  report_.converged = true;
  report_.error_bound = 0;
}

void MergedReport::add(const SystemPlan& system, SolveReport part) {
  if (system.patches.size() > largest_) {
    largest_ = system.patches.size();
    report_.method = part.method;
  }
  if (histories_.empty() || (report_.converged && !part.converged)) report_.stopped = part.stopped;
  if (report_.message.empty()) report_.message = part.message;
  report_.converged &= part.converged;
  report_.iterations = std::max(report_.iterations, part.iterations);
  report_.refinements = std::max(report_.refinements, part.refinements);
  // |B - B*| of a system is below its bound times its largest B*, which no whole scene's is below
  report_.error_bound = std::max(report_.error_bound, part.error_bound);
  report_.condition_estimate = std::max(report_.condition_estimate, part.condition_estimate);
  Eigen::RowVectorXd squares = Eigen::RowVectorXd::Zero(emission_.cols());
  for (const int i : system.patches) squares += mesh_.areas[i] * emission_.row(i).cwiseAbs2();
  squares_.push_back(std::move(squares));
  residuals_.push_back(part.relative_residual);
  histories_.push_back(std::move(part.history));
}

double MergedReport::together(const std::vector<double>& residuals) const {
  Eigen::RowVectorXd missed = Eigen::RowVectorXd::Zero(emission_.cols());
  for (std::size_t k = 0; k < residuals.size(); ++k) missed += residuals[k] * residuals[k] * squares_[k];
  Eigen::RowVectorXd whole = Eigen::RowVectorXd::Zero(emission_.cols());
  for (int i = 0; i < mesh_.size(); ++i) whole += mesh_.areas[i] * emission_.row(i).cwiseAbs2();
  double worst = 0;
  for (Eigen::Index c = 0; c < whole.size(); ++c) {
    if (whole[c] > 0) worst = std::max(worst, std::sqrt(missed[c] / whole[c]));
  }
  return worst;
}

SolveReport MergedReport::take() {
  // one system is told as it is
  if (residuals_.size() == 1) {
    report_.relative_residual = residuals_.front();
    report_.history = std::move(histories_.front());
    return std::move(report_);
  }
  report_.relative_residual = together(residuals_);
  std::size_t longest = 0;
  for (const auto& history : histories_) longest = std::max(longest, history.size());
  for (std::size_t k = 0; k < longest; ++k) {
    Iteration iteration;
    iteration.number = static_cast<int>(k);
    iteration.error_bound = 0;
    std::vector<double> residuals;
    for (const auto& history : histories_) {
      if (history.empty()) {
        residuals.push_back(0);
        continue;
      }
      const Iteration& own = history[std::min(k, history.size() - 1)];
      residuals.push_back(own.relative_residual);
      iteration.error_bound = std::max(iteration.error_bound, own.error_bound);
    }
    iteration.relative_residual = together(residuals);
    report_.history.push_back(iteration);
  }
  return std::move(report_);
}

}  // namespace luxel
