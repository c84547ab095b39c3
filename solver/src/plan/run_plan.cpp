#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "luxel/plan.h"
#include "plan/cost_model.h"
#include "plan/error_bar.h"
#include "plan/merged_report.h"
#include "plan/solved_channels.h"

namespace luxel {

namespace {

/// The enclosures of some patches by themselves.
Enclosures part_of(const Enclosures& all, const std::vector<int>& patches) {
  Enclosures part;
  std::vector<int> place(all.count, -1);
  part.closed = true;
  for (const int i : patches) {
    const int e = all.enclosure[i];
    if (place[e] < 0) {
      place[e] = part.count++;
      part.enclosure_closed.push_back(all.enclosure_closed[e]);
      part.closed = part.closed && all.enclosure_closed[e];
    }
    part.enclosure.push_back(place[e]);
    part.open_share.push_back(all.open_share[i]);
    part.back_share.push_back(all.back_share[i]);
    part.share_error.push_back(all.share_error[i]);
    if (!all.share_rays.empty()) part.share_rays.push_back(all.share_rays[i]);
  }
  return part;
}

class Run {
 public:
  Run(const Plan& plan, const PatchMesh& mesh, const PlanOptions& options, const PlanListener& listener)
      : plan_(plan),
        mesh_(mesh),
        options_(options),
        listener_(listener),
        reflectance_(reflectance(mesh)),
        emission_(emission(mesh)),
        report_(mesh, emission_, options.solve) {
    if (plan.patches != mesh.size()) throw std::invalid_argument("run_plan: the plan is not of this mesh");
    result_.solution.radiosity = emission_;
    result_.solution.irradiance = PatchField::Zero(emission_.rows(), emission_.cols());
    result_.energy.emitted = result_.energy.absorbed = result_.energy.escaped =
        Eigen::RowVectorXd::Zero(emission_.cols());
    result_.row_sums.assign(mesh.size(), std::numeric_limits<double>::quiet_NaN());
    result_.sky_shares = result_.row_sums;
  }

  /// Assembles and closes one system.
  std::unique_ptr<DenseOperator> assemble(const SystemPlan& system, const Enclosures& enclosures) {
    enter(PlanStage::assembling);
    PatchMesh part = sub_mesh(mesh_, system.patches, system.closed);
    if (system.hiding_polygons == 0 && system.closed) part.occluders.triangles.clear();
    FormFactorOptions how = options_.form_factors;
    how.precision = system.precision;
    how.keep_idle_occluders = plan_.keep_idle_occluders;
    how.sky_shares = !system.closed;
    FormFactors factors = form_factors(part, how, listener_.progress);
    const std::vector<double> raw = row_sums(factors.exchange_areas, part.areas);
    for (std::size_t k = 0; k < raw.size(); ++k) result_.row_sums[system.patches[k]] = raw[k];
    for (std::size_t k = 0; k < factors.sky_shares.size(); ++k) {
      result_.sky_shares[system.patches[k]] = factors.sky_shares[k];
    }
    add(result_.form_factors, factors.report);
    const double limit = most_correction * how.accuracy;
    ClosedOperator closed = close_rows(std::move(factors.exchange_areas), part.areas,
                                       part_of(enclosures, system.patches), listener_.progress, limit);
    if (closed.closure.unclosed >= 0) {
      closed.closure.unclosed = system.patches[closed.closure.unclosed];
      closed.closure.message =
          closed.closure.refused_correction > 0
              ? refused_message(closed.closure.unclosed, closed.closure.refused_correction, limit)
              : unclosed_message(closed.closure.unclosed);
    }
    add(result_.closure, closed.closure);
    return std::move(closed.transport);
  }

  void solve_system(const SystemPlan& system, const TransportOperator& transport) {
    enter(PlanStage::solving);
    result_.operator_bytes = std::max(result_.operator_bytes, transport.bytes());
    const std::vector<int>& patches = system.patches;
    const std::vector<int>& channels = system.channels.solved;
    const PatchField rho = reflectance_(patches, channels), emitted = emission_(patches, channels);
    RadiositySolution solved = solve(transport, rho, emitted, system);
    report_.add(system, std::move(solved.report));
    solved.radiosity = expanded(solved.radiosity, system.channels);
    solved.irradiance = expanded(solved.irradiance, system.channels);
    result_.solution.radiosity(patches, Eigen::all) = solved.radiosity;
    result_.solution.irradiance(patches, Eigen::all) = solved.irradiance;
    add_energy(energy(transport, reflectance_(patches, Eigen::all), emission_(patches, Eigen::all), solved));
    for (const int i : patches) solved_[i] = 1;
  }

  bool stopped() const { return report_.report().stopped == Stopped::caller; }

  PlannedSolution finish() {
    // nothing arrives at the others, and all that they emit is gone
    for (int i = 0; i < mesh_.size(); ++i) {
      if (solved_[i]) continue;
      const Eigen::RowVectorXd power = mesh_.areas[i] * emission_.row(i);
      result_.energy.emitted += power;
      result_.energy.escaped += power;
    }
    Energy& sum = result_.energy;
    for (Eigen::Index c = 0; c < sum.emitted.size(); ++c) {
      if (sum.emitted[c] == 0) continue;
      const double missing = std::abs(sum.emitted[c] - sum.absorbed[c] - sum.escaped[c]);
      sum.imbalance = std::max(sum.imbalance, missing / sum.emitted[c]);
    }
    const bool stopped_early = stopped();
    result_.solution.report = report_.take();
    result_.rays = result_.form_factors.rays;
    if (options_.error_bar && !options_.solve.bounces && !stopped_early) measure();
    enter(PlanStage::done);
    return std::move(result_);
  }

 private:
  /// The operator's error.
  void measure() {
    if ((emission_.array() == 0).all()) return;
    enter(PlanStage::measuring);
    const FormFactorReport& done = result_.form_factors;
    const double seconds =
        assembly_seconds(static_cast<double>(done.facing_pairs), options_.form_factors.accuracy) +
        visibility_seconds(static_cast<double>(done.exact_pairs), static_cast<double>(done.sampled_pairs),
                           static_cast<double>(done.rays));
    const OperatorErrorOptions probing = error_bar_options(mesh_, options_, seconds);
    result_.operator_error = operator_error(mesh_, RayScene(mesh_.occluders), reflectance_, emission_,
                                            result_.solution, result_.row_sums, probing, listener_.progress);
  }

  void enter(PlanStage stage) const {
    if (listener_.on_stage) listener_.on_stage(stage);
  }

  RadiositySolution solve(const TransportOperator& transport, const PatchField& rho,
                          const PatchField& emitted, const SystemPlan& system) {
    SolveOptions how = options_.solve;
    how.method = system.method;
    if (how.on_iteration) {
      how.on_iteration = [&, tell = options_.solve.on_iteration](const Iteration& iteration) {
        Iteration told = iteration;
        PatchField whole;
        told.radiosity = nullptr;
        if (iteration.radiosity && plan_.systems.size() == 1) {
          whole = emission_;
          whole(system.patches, Eigen::all) = expanded(*iteration.radiosity, system.channels);
          told.radiosity = &whole;
        }
        return tell(told);
      };
    }
    try {
      return luxel::solve(transport, rho, emitted, how);
    } catch (const SingularSystem& singular) {
      throw SingularSystem(system.patches[singular.patch()], system.channels.solved[singular.channel()],
                           singular.emits());
    }
  }

  void add_energy(const Energy& part) {
    result_.energy.emitted += part.emitted;
    result_.energy.absorbed += part.absorbed;
    result_.energy.escaped += part.escaped;
  }

  static void add(FormFactorReport& sum, const FormFactorReport& part) {
    sum.pairs += part.pairs;
    sum.facing_pairs += part.facing_pairs;
    sum.hidden_pairs += part.hidden_pairs;
    sum.partial_pairs += part.partial_pairs;
    sum.exact_pairs += part.exact_pairs;
    sum.sampled_pairs += part.sampled_pairs;
    sum.rays += part.rays;
    sum.occluders += part.occluders;
    sum.estimated_error = std::max(sum.estimated_error, part.estimated_error);
  }

  static void add(ClosureReport& worst, const ClosureReport& part) {
    for (auto [a, b] : {std::pair(&worst.before, &part.before), std::pair(&worst.after, &part.after)}) {
      a->max = std::max(a->max, b->max);
      a->rms = std::max(a->rms, b->rms);
    }
    worst.largest_correction = std::max(worst.largest_correction, part.largest_correction);
    worst.refused_correction = std::max(worst.refused_correction, part.refused_correction);
    worst.applied |= part.applied;
    worst.iterations += part.iterations;
    if (worst.unclosed >= 0 || part.unclosed < 0) return;
    worst.unclosed = part.unclosed;
    worst.message = part.message;
  }

  const Plan& plan_;
  const PatchMesh& mesh_;
  const PlanOptions& options_;
  const PlanListener& listener_;
  PatchField reflectance_, emission_;
  MergedReport report_;
  PlannedSolution result_;
  std::vector<char> solved_ = std::vector<char>(mesh_.size(), 0);
};

}  // namespace

PlannedSolution run_plan(const Plan& plan, const PatchMesh& mesh, const Enclosures& enclosures,
                         const PlanOptions& options, const PlanListener& listener) {
  Run run(plan, mesh, options, listener);
  for (const SystemPlan& system : plan.systems) {
    run.solve_system(system, *run.assemble(system, enclosures));
    if (run.stopped()) break;
  }
  return run.finish();
}

PlannedSolution run_plan(const Plan& plan, const TransportOperator& transport, const PatchMesh& mesh,
                         const PlanOptions& options, const PlanListener& listener) {
  if (plan.systems.size() != 1 || static_cast<int>(plan.systems[0].patches.size()) != transport.size()) {
    throw std::invalid_argument("run_plan: an operator of all patches needs a plan of one system");
  }
  Run run(plan, mesh, options, listener);
  run.solve_system(plan.systems[0], transport);
  return run.finish();
}

}  // namespace luxel
