#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "luxel/gather_operator.h"
#include "transport/gather/net_size.h"

namespace luxel {

namespace {

// Error of single patches' irradiance: error_at_one rays^-error_order, measured on the Cornell box
// (docs/decisions/0010-gather.md). The lower one holds for packets that are small against their polygon,
// where the fit takes the noise of neighbours out.
constexpr double error_at_one = 0.52, fitted_error_at_one = 0.36, error_order = 0.67;
constexpr int patches_of_large_polygon = 2000;

// Hits stored in all, where a quarter of the rays would be more: what is iterated on is an average over so
// many that its own error does not show.
constexpr double stored_in_all = 0x1p24;

// Emitters that cover more of the area are met by the rays as well as other patches are.
constexpr double largest_share_apart = 0.25;

// Beyond so many lamps (flat pieces that emit) looking at each from each patch costs more than it gains.
constexpr std::size_t most_lamps = 256;

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument("gather: " + message);
}

}  // namespace

GatherPlan gather_plan(const PatchMesh& mesh, const PatchField& emission, const GatherOptions& options) {
  require(emission.rows() == mesh.size(), "emission has " + std::to_string(emission.rows()) + " rows for " +
                                              std::to_string(mesh.size()) + " patches");
  require((emission.array() >= 0).all() && emission.allFinite(), "emission must be finite and not negative");
  require(options.accuracy > 0 && options.accuracy < 1, "accuracy must lie between 0 and 1");
  const auto in_range = [&](const std::optional<int>& rays, const std::string& name) {
    require(!rays || (*rays >= least_rays && *rays <= most_rays), name + " must be 16 to 1048576");
  };
  in_range(options.rays, "rays");
  in_range(options.stored_rays, "stored_rays");
  in_range(options.shadow_rays, "shadow_rays");

  GatherPlan plan;
  const bool fine = options.fit && mesh.size() / patches_of_large_polygon > mesh.occluders.polygon_count;
  const double at_one = fine ? fitted_error_at_one : error_at_one;
  const double wanted = std::pow(at_one / options.accuracy, 1 / error_order);
  plan.rays = options.rays.value_or(net_size(std::min<double>(wanted, most_rays / 2)));
  const double affordable = stored_in_all / std::max(1, mesh.size());
  const int quarter = std::max(least_rays, net_size(plan.rays / 4.0));
  plan.stored_rays = std::min(
      plan.rays, options.stored_rays.value_or(affordable < quarter ? net_within(affordable) : quarter));
  plan.shadow_rays = options.shadow_rays.value_or(plan.rays);

  double emitting = 0, total = 0;
  std::vector<int> polygons;
  for (int i = 0; i < mesh.size(); ++i) {
    total += mesh.areas[i];
    if (!(emission.row(i).array() > 0).any()) continue;
    emitting += mesh.areas[i];
    if (polygons.empty() || polygons.back() != mesh.polygons[i]) polygons.push_back(mesh.polygons[i]);
  }
  std::sort(polygons.begin(), polygons.end());
  const auto lamps =
      static_cast<std::size_t>(std::unique(polygons.begin(), polygons.end()) - polygons.begin());
  plan.direct_apart = emitting > 0 && emitting <= largest_share_apart * total && lamps <= most_lamps;

  // stored hits; three to eight fields in float64 in the iteration; texels, packets and the packed field
  const auto patches = static_cast<std::size_t>(mesh.size());
  const auto columns = static_cast<std::size_t>(emission.cols());
  plan.bytes = patches * (4 * static_cast<std::size_t>(plan.stored_rays) + 64 * columns + 100);
  return plan;
}

}  // namespace luxel
