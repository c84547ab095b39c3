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
#include "transport/gather/stored_rays.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;
constexpr std::size_t packets_a_task = 4;

// Rays of a packet between two visits to the sums: their patches stay in the first cache.
constexpr int rays_a_visit = 128;

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
  FinalGather(const PatchMesh& mesh, const GatherRays& rays, const GatherOperator& stored, bool fit)
      : mesh_(mesh), rays_(rays), stored_(stored), fit_(fit) {}

  PatchField operator()(const PatchField& x, const Progress& progress, double& smoothed,
                        std::vector<double>& row_sums) const {
    std::vector<PackedField> fields;
    for (Eigen::Index c = 0; c < x.cols(); c += columns_a_pass) fields.emplace_back(x, c);
    PatchField gathered(x.rows(), x.cols());
    std::vector<double> shares(rays_.packets().size(), 0.0);
    row_sums.assign(x.rows(), 0.0);
    StageProgress stage(progress, "gather", std::max<double>(1, static_cast<double>(rays_.packets().size())));
    const tbb::blocked_range<std::size_t> all(0, rays_.packets().size(), packets_a_task);
    tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& range) {
      if (stage.cancelled()) return;
      std::vector<PacketField> sums(fields.size()), halves(fields.size());
      for (std::size_t p = range.begin(); p < range.end(); ++p) {
        const Lost lost = sum_up(p, fields, sums, halves);
        const auto& packet = rays_.packets()[p];
        const std::span<const int> patches(packet.data(), used_lanes(packet));
        for (std::size_t k = 0; k < patches.size(); ++k) {
          row_sums[patches[k]] = 1 - static_cast<double>(lost[k]) / rays_.count();
        }
        for (std::size_t f = 0; f < fields.size(); ++f) {
          if (fit_) shares[p] += fit_packet(mesh_, patches, halves[f], sums[f]) / fields.size();
          const auto column = static_cast<Eigen::Index>(f) * columns_a_pass;
          for (std::size_t k = 0; k < patches.size(); ++k) {
            for (Eigen::Index c = column; c < std::min(x.cols(), column + columns_a_pass); ++c) {
              gathered(patches[k], c) = sums[f][k][c - column];
            }
          }
        }
      }
      stage.add(static_cast<double>(range.size()));
    });
    stage.finish();
    smoothed = 0;
    for (double share : shares) smoothed += share / static_cast<double>(shares.size());
    return gathered;
  }

 private:
  using Lost = std::array<int, lanes>;  // rays of each patch that met nothing

  /// Means over all rays of a packet, and over the first half of them.
  Lost sum_up(std::size_t p, const std::vector<PackedField>& fields, std::vector<PacketField>& sums,
              std::vector<PacketField>& halves) const {
    for (PacketField& sum : sums) sum.fill(Eigen::Array4d::Zero());
    const int count = rays_.count(), half = count / 2, kept = stored_.rays();
    std::array<std::uint32_t, rays_a_visit * lanes> fresh;
    const auto nothing = static_cast<std::uint32_t>(mesh_.size());
    Lost lost{};
    for (int q = 0; q < count;) {
      // up to the end of the stored ones, the half, a visit
      int end = std::min(count, q + rays_a_visit);
      if (q < kept) end = std::min(end, kept);
      if (q < half) end = std::min(end, half);
      const std::size_t rays = static_cast<std::size_t>(end - q) * lanes;
      std::span<const std::uint32_t> met(fresh.data(), rays);
      if (q < kept) {
        met = stored_.hits(p).subspan(static_cast<std::size_t>(q) * lanes, rays);
      } else {
        rays_.trace(p, q, end - q, fresh.data());
      }
      for (std::size_t f = 0; f < fields.size(); ++f) add(fields[f], met, sums[f]);
      for (std::size_t m = 0; m < met.size(); m += lanes) {
        for (int k = 0; k < lanes; ++k) lost[k] += met[m + k] == nothing;
      }
      q = end;
      if (q == half) halves = sums;
    }
    for (std::size_t f = 0; f < fields.size(); ++f) {
      for (int k = 0; k < lanes; ++k) {
        sums[f][k] /= count;
        halves[f][k] /= half;
      }
    }
    return lost;
  }

  const PatchMesh& mesh_;
  const GatherRays& rays_;
  const GatherOperator& stored_;
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
                          const PatchField& emission, const PatchField& source, bool apart,
                          SolveOptions solving) {
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
  const PatchField left = source + reflectance.cwiseProduct(iterated.irradiance) - iterated.radiosity;
  iterated.report.relative_residual = largest_share(norms(mesh, left), emitted);
  for (Iteration& iteration : iterated.report.history) iteration.relative_residual *= relative;
  return iterated;
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
  const GatherRays& rays = *light.rays;
  light.stored = stored_rays(rays, report.plan.stored_rays, mesh, progress);
  if (on_stage) on_stage(GatherStage::iteration);
  RadiositySolution iterated = iterate(mesh, *light.stored, reflectance, emission, source, apart, solving);
  if (on_stage) on_stage(GatherStage::rays);
  solution.light.report = std::move(iterated.report);

  const FinalGather gather(mesh, rays, *light.stored, options.fit && apart);
  PatchField& irradiance = solution.light.irradiance;
  irradiance = gather(iterated.radiosity, progress, report.smoothed, solution.row_sums);
  if (apart) irradiance += solution.direct;
  solution.light.radiosity = emission + reflectance.cwiseProduct(irradiance);
  report.rays = static_cast<std::int64_t>(mesh.size()) * report.plan.rays;
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
