#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "luxel/gather_operator.h"
#include "stage_progress.h"
#include "transport/gather/gathered_light.h"
#include "transport/gather/packet_fit.h"
#include "transport/gather/packets.h"
#include "transport/gather/rays_needed.h"
#include "transport/gather/stored_rays.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;
constexpr std::size_t packets_a_task = 4;

// Columns in one pass over the hits.
constexpr int columns_a_pass = 4;

// Mean reflectance above which directions are orthogonalised rather than bounces added up.
constexpr double dark = 0.75;

// Memory for these directions, and how many are worth having.
constexpr double bytes_for_directions = 256e6;
constexpr int least_directions = 6;

/// The method for the iteration on U: what the caller asked, or the one with the least memory that converges
/// well.
SolveOptions iteration(const PatchMesh& mesh, const PatchField& reflectance, SolveOptions solving) {
  if (solving.method != Method::automatic) return solving;
  const Eigen::Map<const Eigen::RowVectorXd> areas(mesh.areas.data(), mesh.size());
  const double brightest = mesh.size() == 0 ? 0 : (areas * reflectance).maxCoeff() / areas.sum();
  solving.method = brightest > dark ? Method::gmres : Method::neumann;
  const double field = sizeof(double) * static_cast<double>(std::max<Eigen::Index>(1, reflectance.size()));
  solving.restart = std::clamp(static_cast<int>(bytes_for_directions / field), least_directions,
                               std::max(least_directions, solving.restart));
  return solving;
}

/// A field as the rays read it: four columns of float a patch, and zeros for what meets nothing.
class PackedField {
 public:
  PackedField(const PatchField& field, Eigen::Index column)
      : rows_(field.rows() + 1, Eigen::Array4f::Zero()) {
    const auto count = std::min<Eigen::Index>(columns_a_pass, field.cols() - column);
    for (Eigen::Index i = 0; i < field.rows(); ++i) {
      for (Eigen::Index c = 0; c < count; ++c) rows_[i][c] = static_cast<float>(field(i, column + c));
    }
  }
  const Eigen::Array4f& operator[](std::uint32_t patch) const { return rows_[patch]; }

 private:
  std::vector<Eigen::Array4f, Eigen::aligned_allocator<Eigen::Array4f>> rows_;
};

void add(const PackedField& field, std::span<const std::uint32_t> met, PacketField& sums) {
  for (std::size_t q = 0; q < met.size(); q += lanes) {
    for (int k = 0; k < lanes; ++k) sums[k] += field[met[q + k]].cast<double>();
  }
}

/// F X with all rays: those stored, then the rest of the same net, which are not.
class FinalGather {
 public:
  /// @param kept  of the stored rays: those that belong to the same nets, all or none
  FinalGather(const PatchMesh& mesh, const GatherRays& rays, const GatherOperator& stored, int kept, bool fit)
      : mesh_(mesh), rays_(rays), stored_(stored), kept_(kept), fit_(fit) {}

  PatchField operator()(const PatchField& x, const Progress& progress, double& smoothed,
                        std::vector<double>& row_sums) const {
    std::vector<PackedField> fields;
    for (Eigen::Index c = 0; c < x.cols(); c += columns_a_pass) fields.emplace_back(x, c);
    PatchField gathered(x.rows(), x.cols());
    std::vector<double> shares(rays_.packets().size(), 0.0);
    row_sums.assign(x.rows(), 0.0);
    const std::size_t packets = rays_.packets().size(), together = rays_.packets_together();
    StageProgress stage(progress, "gather", std::max<double>(1, static_cast<double>(packets)));
    const tbb::blocked_range<std::size_t> all(0, (packets + together - 1) / together,
                                              std::max<std::size_t>(1, packets_a_task / together));
    tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& range) {
      if (stage.cancelled()) return;
      std::vector<PacketSums> sums(together);
      for (std::size_t block = range.begin(); block < range.end(); ++block) {
        const std::size_t first = block * together, count = std::min(together, packets - first);
        sum_up(first, count, fields, sums);
        for (std::size_t k = 0; k < count; ++k) {
          shares[first + k] = finish(first + k, sums[k], gathered, row_sums);
        }
        stage.add(static_cast<double>(count));
      }
    });
    stage.finish();
    smoothed = 0;
    for (double share : shares) smoothed += share / static_cast<double>(shares.size());
    return gathered;
  }

 private:
  /// Of one packet: sums over its rays for each packed field, those over the first half, and how many rays of
  /// each patch met nothing.
  struct PacketSums {
    std::vector<PacketField> all, half;
    std::array<int, lanes> lost;
  };

  /// Means over all rays of some packets, and over the first half of them.
  void sum_up(std::size_t first, std::size_t packets, const std::vector<PackedField>& fields,
              std::vector<PacketSums>& sums) const {
    for (PacketSums& sum : sums) {
      sum.all.resize(fields.size());
      for (PacketField& field : sum.all) field.fill(Eigen::Array4d::Zero());
      sum.lost.fill(0);
    }
    const int count = rays_.count(), half = count / 2;
    const int a_visit = rays_.rays_together();
    std::vector<std::uint32_t> fresh(packets * a_visit * lanes);
    for (int q = 0; q < count;) {
      // up to the end of the stored ones, the half, a visit
      int end = std::min(count, q + a_visit);
      if (q < kept_) end = std::min(end, kept_);
      if (q < half) end = std::min(end, half);
      const std::size_t rays = static_cast<std::size_t>(end - q) * lanes;
      if (q >= kept_) rays_.trace_together(first, packets, q, end - q, fresh.data());
      for (std::size_t p = 0; p < packets; ++p) {
        std::span<const std::uint32_t> met(fresh.data() + p * rays, rays);
        if (q < kept_) met = stored_.hits(first + p).subspan(static_cast<std::size_t>(q) * lanes, rays);
        add_up(met, fields, sums[p]);
        if (end == half) sums[p].half = sums[p].all;
      }
      q = end;
    }
    for (std::size_t p = 0; p < packets; ++p) {
      for (std::size_t f = 0; f < fields.size(); ++f) {
        for (int k = 0; k < lanes; ++k) {
          sums[p].all[f][k] /= count;
          sums[p].half[f][k] /= half;
        }
      }
    }
  }

  void add_up(std::span<const std::uint32_t> met, const std::vector<PackedField>& fields,
              PacketSums& sums) const {
    const auto nothing = static_cast<std::uint32_t>(mesh_.size());
    for (std::size_t f = 0; f < fields.size(); ++f) add(fields[f], met, sums.all[f]);
    for (std::size_t m = 0; m < met.size(); m += lanes) {
      for (int k = 0; k < lanes; ++k) sums.lost[k] += met[m + k] == nothing;
    }
  }

  /// Smooths a packet and puts it where it belongs; gives the mean share by which it followed its fits.
  double finish(std::size_t p, PacketSums& sums, PatchField& gathered, std::vector<double>& row_sums) const {
    const auto& packet = rays_.packets()[p];
    const std::span<const int> patches(packet.data(), used_lanes(packet));
    double share = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      row_sums[patches[k]] = 1 - static_cast<double>(sums.lost[k]) / rays_.count();
    }
    for (std::size_t f = 0; f < sums.all.size(); ++f) {
      if (fit_) share += fit_packet(mesh_, patches, sums.half[f], sums.all[f]) / sums.all.size();
      const auto column = static_cast<Eigen::Index>(f) * columns_a_pass;
      for (std::size_t k = 0; k < patches.size(); ++k) {
        for (Eigen::Index c = column; c < std::min(gathered.cols(), column + columns_a_pass); ++c) {
          gathered(patches[k], c) = sums.all[f][k][c - column];
        }
      }
    }
    return share;
  }

  const PatchMesh& mesh_;
  const GatherRays& rays_;
  const GatherOperator& stored_;
  int kept_;
  bool fit_;
};

/// Area-weighted norms of each column.
Eigen::RowVectorXd norms(const PatchMesh& mesh, const PatchField& field) {
  const Eigen::Map<const Eigen::RowVectorXd> areas(mesh.areas.data(), mesh.size());
  return (areas * field.cwiseAbs2()).cwiseSqrt();
}

/// The largest of part[c] / whole[c] over columns where there is a whole.
double largest_share(const Eigen::RowVectorXd& part, const Eigen::RowVectorXd& whole) {
  double largest = 0;
  for (Eigen::Index c = 0; c < whole.size(); ++c) {
    if (whole[c] > 0) largest = std::max(largest, part[c] / whole[c]);
  }
  return largest;
}

/// Solves for `source`, with the tolerance and the residuals relative to the emission.
RadiositySolution iterate(const PatchMesh& mesh, const GatherOperator& stored, const PatchField& reflectance,
                          const PatchField& emission, PatchField source, bool apart, SolveOptions solving) {
  const Eigen::RowVectorXd emitted = norms(mesh, emission);
  const double relative = largest_share(norms(mesh, source), emitted);
  solving = iteration(mesh, reflectance, solving);
  if (relative > 0) solving.tolerance = std::min(solving.tolerance / relative, 0.5);
  if (solving.on_iteration) {
    solving.on_iteration = [&, tell = solving.on_iteration](const Iteration& iteration) {
      Iteration told = iteration;
      told.relative_residual *= relative;
      PatchField whole;
      if (apart && iteration.radiosity) {
        whole = emission + *iteration.radiosity;
        told.radiosity = &whole;
      }
      return tell(told);
    };
  }
  RadiositySolution iterated = solve(stored, reflectance, source, solving);
  // in the place of the source, which is not needed any more
  source += reflectance.cwiseProduct(iterated.irradiance) - iterated.radiosity;
  iterated.report.relative_residual = largest_share(norms(mesh, source), emitted);
  for (Iteration& iteration : iterated.report.history) iteration.relative_residual *= relative;
  return iterated;
}

/// As many rays as the sample calls for, and no fewer than are stored.
int rays_needed_for(const PatchMesh& mesh, const GatheredLight& light, const RadiositySolution& iterated,
                    const GatherOptions& options) {
  const GatheredSolution& solution = light.solution;
  const GatherPlan& plan = solution.report.plan;
  const bool apart = plan.direct_apart;
  PatchField whole = iterated.irradiance;
  if (apart) whole += solution.direct;
  const Eigen::RowVectorXd level = norms(mesh, whole) / std::sqrt(total_area(mesh));
  const int needed = rays_needed(mesh, *light.rays, iterated.radiosity, level, options.fit && apart,
                                 plan.rays, options.accuracy);
  return std::max(needed, plan.stored_rays);
}

}  // namespace

GatheredLight gather_light(const PatchMesh& mesh, const RayScene& occluders, const PatchField& reflectance,
                           const PatchField& emission, const GatherOptions& options,
                           const SolveOptions& solving, const Progress& progress,
                           const std::function<void(GatherStage)>& on_stage) {
  if (reflectance.rows() != emission.rows() || reflectance.cols() != emission.cols()) {
    throw std::invalid_argument("solve_gathered: reflectance and emission differ in shape");
  }
  if (solving.bounces) throw std::invalid_argument("solve_gathered: cannot count bounces");
  GatheredLight light;
  GatheredSolution& solution = light.solution;
  GatherReport& report = solution.report;
  report.plan = gather_plan(mesh, emission, options);
  const bool apart = report.plan.direct_apart;

  // U = B - E starts from the direct light, B from the emission
  PatchField source = emission;
  if (apart) {
    DirectLight direct = direct_irradiance(mesh, occluders, emission, options, progress);
    report.shadow_rays = direct.rays;
    report.partly_lit = direct.partly_lit;
    solution.direct = std::move(direct.irradiance);
    source = reflectance.cwiseProduct(solution.direct);
  }
  light.rays = std::make_unique<GatherRays>(mesh, occluders, report.plan.rays, options.seed);
  GatherRays& rays = *light.rays;
  light.stored = stored_rays(rays, report.plan.stored_rays, mesh, progress);
  if (on_stage) on_stage(GatherStage::iteration);
  RadiositySolution iterated =
      iterate(mesh, *light.stored, reflectance, emission, std::move(source), apart, solving);
  if (on_stage) on_stage(GatherStage::rays);
  solution.light.report = std::move(iterated.report);

  PatchField& irradiance = solution.light.irradiance;
  report.rays = static_cast<std::int64_t>(mesh.size()) * report.plan.stored_rays;
  report.partial = solution.light.report.stopped == Stopped::caller;
  if (!report.partial) {
    if (!options.rays) report.plan.rays = rays_needed_for(mesh, light, iterated, options);
    const int known = rays.set_count(report.plan.rays) ? report.plan.stored_rays : 0;
    iterated.irradiance.resize(0, 0);
    try {
      const FinalGather gather(mesh, rays, *light.stored, known, options.fit && apart);
      irradiance = gather(iterated.radiosity, progress, report.smoothed, solution.row_sums);
      report.rays += static_cast<std::int64_t>(mesh.size()) * (report.plan.rays - known);
    } catch (const Cancelled&) {
      if (!options.keep_partial) throw;
      report.partial = true;
    }
  }
  if (report.partial) {
    irradiance.resize(emission.rows(), emission.cols());
    light.stored->apply(iterated.radiosity.data(), irradiance.data(), static_cast<int>(emission.cols()));
    solution.row_sums.assign(light.stored->row_sums().begin(), light.stored->row_sums().end());
  }
  if (apart) irradiance += solution.direct;
  solution.light.radiosity = emission + reflectance.cwiseProduct(irradiance);
  report.asked_twice = rays.asked_twice();
  report.bytes = light.stored->bytes() + rays.bytes();
  return light;
}

GatheredSolution solve_gathered(const PatchMesh& mesh, const RayScene& occluders,
                                const PatchField& reflectance, const PatchField& emission,
                                const GatherOptions& options, const SolveOptions& solving,
                                const Progress& progress) {
  return gather_light(mesh, occluders, reflectance, emission, options, solving, progress).solution;
}

}  // namespace luxel
