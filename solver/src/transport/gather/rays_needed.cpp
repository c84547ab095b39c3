#include "transport/gather/rays_needed.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "transport/gather/net_size.h"
#include "transport/gather/packet_fit.h"
#include "transport/gather/packets.h"

namespace luxel {

namespace {

constexpr int lanes = GatherOperator::lanes;

// Packets looked at: the noise of 16 of them is known to a tenth.
constexpr std::size_t least_packets = 16, most_packets = 256;
constexpr double good_packets = 96;

// Rays of a look at a packet, and how many times fewer the other look at it takes: both are nets.
constexpr int most_rays_a_look = 1024, least_rays_a_look = 64, fewer = 4;

// Bounds of the order at which the noise falls: by chance, and of smooth light.
constexpr double least_order = 0.5, most_order = 0.7;

// Of the accuracy: direct light and the iteration have errors too.
constexpr double share_of_rays = 0.9;

/// Squared differences of two looks, summed over patches: at few rays and at all, as gathered and, at all,
/// fitted.
struct Scatter {
  Eigen::Array4d few = Eigen::Array4d::Zero(), all = few, fitted = few;
  double area = 0;
};

/// The irradiance of a packet by the first `count` of its rays.
PacketField means(const PatchMesh& mesh, const std::vector<std::uint32_t>& met, int count,
                  const PatchField& field, std::span<const int> patches, bool fit) {
  PacketField all, half;
  all.fill(Eigen::Array4d::Zero());
  for (int q = 0; q < count; ++q) {
    if (q == count / 2) half = all;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const std::uint32_t end = met[static_cast<std::size_t>(q) * lanes + k];
      if (end == static_cast<std::uint32_t>(mesh.size())) continue;
      for (Eigen::Index c = 0; c < field.cols(); ++c) all[k][c] += field(end, c);
    }
  }
  for (int k = 0; k < lanes; ++k) {
    all[k] /= count;
    half[k] /= count / 2;
  }
  if (fit) fit_packet(mesh, patches, half, all);
  return all;
}

Scatter scatter_of(const PatchMesh& mesh, const GatherRays& rays, std::size_t packet, const PatchField& field,
                   bool fit, int count) {
  const auto& members = rays.packets()[packet];
  const std::span<const int> patches(members.data(), used_lanes(members));
  std::array<std::vector<std::uint32_t>, 2> met;
  for (int look = 0; look < 2; ++look) {
    met[look].resize(static_cast<std::size_t>(count) * lanes);
    rays.trace_sample(packet, look, count, met[look].data());
  }
  Scatter scatter;
  const auto add = [&](int used, bool fitted, Eigen::Array4d& squares) {
    const PacketField a = means(mesh, met[0], used, field, patches, fitted);
    const PacketField b = means(mesh, met[1], used, field, patches, fitted);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      squares += mesh.areas[patches[k]] * (a[k] - b[k]).square() / 2;
    }
  };
  add(count / fewer, false, scatter.few);
  add(count, false, scatter.all);
  add(count, fit, scatter.fitted);
  for (const int patch : patches) scatter.area += mesh.areas[patch];
  return scatter;
}

}  // namespace

int rays_needed(const PatchMesh& mesh, const GatherRays& rays, const PatchField& radiosity,
                const Eigen::RowVectorXd& whole, bool fit, int planned, double accuracy) {
  const Eigen::Index columns = std::min<Eigen::Index>(radiosity.cols(), 4);
  const PatchField field = radiosity.leftCols(columns);
  const std::size_t packets = rays.packets().size();
  // as many rays a look as planned, where enough packets can be looked at
  const auto affordable_at = [&](int rays_a_look) {
    return sampling_share * planned * static_cast<double>(packets) / (2 * rays_a_look);
  };
  int count = std::clamp(planned, least_rays_a_look, most_rays_a_look);
  for (int part = 2; part <= 4 && affordable_at(count) < good_packets; part *= 2) {
    count = std::clamp(net_size(planned / static_cast<double>(part)), least_rays_a_look, most_rays_a_look);
  }
  const double affordable = affordable_at(count);
  const std::size_t looks = std::min(
      packets, static_cast<std::size_t>(std::clamp<double>(affordable, least_packets, most_packets)));
  std::vector<Scatter> scatters(looks);
  tbb::parallel_for(std::size_t{0}, looks, [&](std::size_t k) {
    scatters[k] = scatter_of(mesh, rays, (2 * k + 1) * packets / (2 * looks), field, fit, count);
  });
  Scatter sum;
  for (const Scatter& scatter : scatters) {
    sum.few += scatter.few;
    sum.all += scatter.all;
    sum.fitted += scatter.fitted;
    sum.area += scatter.area;
  }
  // squares are many small and a few large ones, of which a sample may hold too few: one standard error more
  Eigen::Array4d spread = Eigen::Array4d::Zero();
  for (const Scatter& scatter : scatters) spread += (scatter.fitted - sum.fitted / looks).square();
  const Eigen::Array4d more = 1 + spread.sqrt() / sum.fitted.max(std::numeric_limits<double>::min());
  sum.few *= more;
  sum.all *= more;
  sum.fitted *= more;
  double most = 0;
  for (Eigen::Index c = 0; c < columns; ++c) {
    if (!(whole[c] > 0)) continue;
    const auto relative = [&](const Eigen::Array4d& squares) {
      return std::sqrt(squares[c] / sum.area) / whole[c];
    };
    const double few = relative(sum.few), all = relative(sum.all);
    if (!(all > 0)) continue;
    const double order = std::clamp(std::log(few / all) / std::log(fewer), least_order, most_order);
    const auto needed = [&](double noise) {
      return count * std::pow(noise / (share_of_rays * accuracy), 1 / order);
    };
    // what the fit takes away at more rays than were looked at is not known: less and less
    const double fitted = needed(relative(sum.fitted));
    most = std::max(most, fitted <= count ? fitted : std::max<double>(count, needed(all)));
  }
  return net_size(most);
}

}  // namespace luxel
