#include "transport/gather/final_gather.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>

#include "stage_progress.h"
#include "transport/gather/packet_fit.h"
#include "transport/gather/packets.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;
constexpr std::size_t packets_a_task = 4;

// Columns in one pass over the hits.
constexpr int columns_a_pass = 4;

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
  PatchRows rows() const { return {reinterpret_cast<const char*>(rows_.data()), sizeof(rows_[0])}; }

 private:
  std::vector<Eigen::Array4f, Eigen::aligned_allocator<Eigen::Array4f>> rows_;
};

/// Adds what the rays of a packet met. Few lanes at a time, whose sums stay in registers.
void add(const PackedField& field, std::span<const std::uint32_t> met, PacketField& sums) {
  constexpr int at_once = 4;
  for (int k = 0; k < lanes; k += at_once) {
    std::array<Eigen::Array4d, at_once> sum;
    std::copy_n(&sums[k], at_once, sum.begin());
    for (std::size_t q = k; q < met.size(); q += lanes) {
      for (int j = 0; j < at_once; ++j) sum[j] += field[met[q + j]].cast<double>();
    }
    std::copy_n(sum.begin(), at_once, &sums[k]);
  }
}

/// F X with all rays: those stored, then the rest of the same net, which are not.
class FinalGather {
 public:
  /// @param kept  of the stored rays: those that belong to the same nets, all or none
  FinalGather(const PatchMesh& mesh, const GatherRays& rays, const GatherOperator& stored, int kept, bool fit)
      : mesh_(mesh), rays_(rays), stored_(stored), kept_(kept), fit_(fit) {}

  GatheredField operator()(const PatchField& x, const Progress& progress) const {
    std::vector<PackedField> fields;
    for (Eigen::Index c = 0; c < x.cols(); c += columns_a_pass) fields.emplace_back(x, c);
    GatheredField gathered;
    gathered.values.resize(x.rows(), x.cols());
    gathered.row_sums.assign(x.rows(), 0.0);
    std::vector<double> shares(rays_.packets().size(), 0.0);
    const std::size_t packets = rays_.packets().size(), together = rays_.packets_together();
    StageProgress stage(progress, "gather", std::max<double>(1, static_cast<double>(packets)));
    const tbb::blocked_range<std::size_t> all(0, (packets + together - 1) / together,
                                              std::max<std::size_t>(1, packets_a_task / together));
    tbb::parallel_for(all, [&](const tbb::blocked_range<std::size_t>& range) {
      if (stage.cancelled()) return;
      std::vector<PacketSums> sums(together);
      std::vector<PacketFrame> frames;
      for (std::size_t block = range.begin(); block < range.end(); ++block) {
        const std::size_t first = block * together, count = std::min(together, packets - first);
        rays_.aim(first, count, frames);
        sum_up(first, frames, fields, sums);
        for (std::size_t k = 0; k < count; ++k) {
          shares[first + k] = finish(first + k, sums[k], gathered);
        }
        stage.add(static_cast<double>(count));
      }
    });
    stage.finish();
    for (double share : shares) gathered.smoothed += share / static_cast<double>(shares.size());
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
  void sum_up(std::size_t first, std::span<const PacketFrame> frames, const std::vector<PackedField>& fields,
              std::vector<PacketSums>& sums) const {
    const std::size_t packets = frames.size();
    for (PacketSums& sum : sums) {
      sum.all.resize(fields.size());
      for (PacketField& field : sum.all) field.fill(Eigen::Array4d::Zero());
      sum.lost.fill(0);
    }
    const int count = rays_.count(), half = count / 2;
    const int a_visit = rays_.rays_together();
    std::vector<std::uint32_t> fresh(packets * a_visit * lanes);
    for (int q = 0; q < count;) {
      // up to the end of the stored ones, a visit
      const int end = std::min(q < kept_ ? kept_ : count, q + a_visit);
      const std::size_t rays = static_cast<std::size_t>(end - q) * lanes;
      if (q >= kept_) rays_.trace_together(first, frames, q, end - q, fresh.data(), fields[0].rows());
      const std::size_t in_half = static_cast<std::size_t>(std::clamp(half - q, 0, end - q)) * lanes;
      for (std::size_t p = 0; p < packets; ++p) {
        std::span<const std::uint32_t> met(fresh.data() + p * rays, rays);
        if (q < kept_) met = stored_.hits(first + p).subspan(static_cast<std::size_t>(q) * lanes, rays);
        add_up(met.first(in_half), fields, sums[p]);
        if (q < half && end >= half) sums[p].half = sums[p].all;
        add_up(met.subspan(in_half), fields, sums[p]);
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
    std::array<int, lanes> lost = sums.lost;
    for (std::size_t m = 0; m < met.size(); m += lanes) {
      for (int k = 0; k < lanes; ++k) lost[k] += met[m + k] == nothing;
    }
    sums.lost = lost;
  }

  /// Smooths a packet and puts it where it belongs; gives the mean share by which it followed its fits.
  double finish(std::size_t p, PacketSums& sums, GatheredField& gathered) const {
    const auto& packet = rays_.packets()[p];
    const std::span<const int> patches(packet.data(), used_lanes(packet));
    double share = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      gathered.row_sums[patches[k]] = 1 - static_cast<double>(sums.lost[k]) / rays_.count();
    }
    for (std::size_t f = 0; f < sums.all.size(); ++f) {
      if (fit_) share += fit_packet(mesh_, patches, sums.half[f], sums.all[f]) / sums.all.size();
      const auto column = static_cast<Eigen::Index>(f) * columns_a_pass;
      for (std::size_t k = 0; k < patches.size(); ++k) {
        for (Eigen::Index c = column; c < std::min(gathered.values.cols(), column + columns_a_pass); ++c) {
          gathered.values(patches[k], c) = sums.all[f][k][c - column];
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

}  // namespace

GatheredField final_gather(const PatchMesh& mesh, const GatherRays& rays, const GatherOperator& stored,
                           int kept, bool fit, const PatchField& x, const Progress& progress) {
  return FinalGather(mesh, rays, stored, kept, fit)(x, progress);
}

}  // namespace luxel
