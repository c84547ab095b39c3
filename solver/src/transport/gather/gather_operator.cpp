#include "luxel/gather_operator.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "stage_progress.h"
#include "transport/gather/gather_rays.h"
#include "transport/gather/packets.h"
#include "transport/gather/stored_rays.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Packets a task: some 10^4 rays, a fraction of a millisecond.
constexpr std::size_t packets_a_task = 4;

// Right-hand sides that share one pass over the hits: a vector of four doubles each.
constexpr int widest = 4;

/// y = F x for `width` columns from `column` on. Sums run over the rays in their order.
template <int width>
void apply_columns(const GatherOperator& transport, const double* x, double* y, int columns, int column) {
  using Row = Eigen::Array<double, width, 1>;
  const std::size_t size = transport.size();
  std::vector<Row, Eigen::aligned_allocator<Row>> rows(size + 1, Row::Zero());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, 4096), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      for (int c = 0; c < width && column + c < columns; ++c) rows[i][c] = x[i * columns + column + c];
    }
  });
  const auto packets = transport.packets();
  const int rays = transport.rays();
  const tbb::blocked_range<std::size_t> all(0, packets.size(), packets_a_task);
  tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t p = range.begin(); p < range.end(); ++p) {
      std::array<Row, lanes> sums;
      sums.fill(Row::Zero());
      const std::uint32_t* hit = transport.hits(p).data();
      for (int q = 0; q < rays; ++q, hit += lanes) {
        for (int k = 0; k < lanes; ++k) sums[k] += rows[hit[k]];
      }
      for (int k = 0; k < used_lanes(packets[p]); ++k) {
        double* out = y + static_cast<std::size_t>(packets[p][k]) * columns + column;
        for (int c = 0; c < width && column + c < columns; ++c) out[c] = sums[k][c] / rays;
      }
    }
  });
}

}  // namespace

GatherOperator::GatherOperator(std::vector<Packet> packets, int rays, std::unique_ptr<std::uint32_t[]> hits,
                               std::vector<double> areas)
    : packets_(std::move(packets)), rays_(rays), hits_(std::move(hits)), areas_(std::move(areas)) {
  if (rays_ < 1) throw std::invalid_argument("GatherOperator: needs a ray or more");
  row_sums_.assign(areas_.size(), 0.0);
  const std::vector<double> ones(areas_.size(), 1.0);
  apply(ones.data(), row_sums_.data(), 1);
}

std::span<const std::uint32_t> GatherOperator::hits(std::size_t packet) const {
  const std::size_t count = static_cast<std::size_t>(rays_) * lanes;
  return {hits_.get() + packet * count, count};
}

void GatherOperator::apply(const double* x, double* y, int columns) const {
  for (int column = 0; column < columns; column += widest) {
    switch (std::min(columns - column, widest)) {
      case 1:
        apply_columns<1>(*this, x, y, columns, column);
        break;
      case 2:
        apply_columns<2>(*this, x, y, columns, column);
        break;
      default:
        apply_columns<widest>(*this, x, y, columns, column);
    }
  }
}

std::size_t GatherOperator::bytes() const {
  return packets_.size() * (sizeof(Packet) + sizeof(std::uint32_t) * lanes * rays_) +
         2 * sizeof(double) * areas_.size();
}

std::unique_ptr<GatherOperator> stored_rays(const GatherRays& rays, int count, const PatchMesh& mesh,
                                            const Progress& progress) {
  const auto packets = rays.packets();
  const std::size_t of_packet = static_cast<std::size_t>(count) * lanes;
  auto hits = std::make_unique_for_overwrite<std::uint32_t[]>(packets.size() * of_packet);
  StageProgress stage(progress, "rays", std::max<double>(1, static_cast<double>(packets.size())));
  const std::size_t together = std::max(packets_a_task, rays.packets_together());
  tbb::parallel_for(std::size_t{0}, (packets.size() + together - 1) / together, [&](std::size_t block) {
    if (stage.cancelled()) return;
    const std::size_t first = block * together, some = std::min(together, packets.size() - first);
    std::vector<PacketFrame> frames;
    rays.aim(first, some, frames);
    rays.trace_together(first, frames, 0, count, &hits[first * of_packet]);
    stage.add(static_cast<double>(some));
  });
  stage.finish();
  return std::make_unique<GatherOperator>(std::vector(packets.begin(), packets.end()), count, std::move(hits),
                                          mesh.areas);
}

std::unique_ptr<GatherOperator> gather_operator(const PatchMesh& mesh, const RayScene& occluders,
                                                const GatherOptions& options, const Progress& progress) {
  const GatherPlan plan = gather_plan(mesh, PatchField::Zero(mesh.size(), 1), options);
  const GatherRays rays(mesh, occluders, plan.rays, options.seed);
  return stored_rays(rays, plan.rays, mesh, progress);
}

}  // namespace luxel
