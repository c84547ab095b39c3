#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "form_factors/visibility_choice.h"
#include "luxel/enclosures.h"

namespace luxel {

namespace {

// Chance that a right row of a scene is called wrong.
constexpr double significance = 1e-2;

// How far from a share that so many independent rays found the true one may be, at z standard errors: to the
// farther end of the score interval (Wilson 1927), which holds for shares near 0 and 1 and does not take the
// share found for the true one.
double wilson_reach(double share, double rays, double z) {
  const double relative = z * z / rays;
  const double middle = (share + relative / 2) / (1 + relative);
  const double half = z / (1 + relative) * std::sqrt(share * (1 - share) / rays + relative / (4 * rays));
  return std::abs(middle - share) + half;
}

}  // namespace

void take_sky_shares(Enclosures& enclosures, const std::vector<double>& sky_shares, double accuracy) {
  if (sky_shares.size() != enclosures.enclosure.size()) {
    throw std::invalid_argument("take_sky_shares: as many shares as patches are needed");
  }
  // where anyone sees a back, who does not may see a small one
  std::vector<char> shows_backs(enclosures.count, 0);
  for (std::size_t i = 0; i < sky_shares.size(); ++i) {
    if (enclosures.back_share[i] > 0) shows_backs[enclosures.enclosure[i]] = 1;
  }
  for (std::size_t i = 0; i < sky_shares.size(); ++i) {
    const int enclosure = enclosures.enclosure[i];
    if (std::isnan(sky_shares[i]) || enclosures.enclosure_closed[enclosure] || shows_backs[enclosure])
      continue;
    enclosures.open_share[i] = sky_shares[i];
    enclosures.share_error[i] = ray_share * accuracy * std::sqrt(sky_shares[i]);
    if (!enclosures.share_rays.empty()) enclosures.share_rays[i] = 0;
  }
}

double largest_by_chance(const Enclosures& enclosures, int patch) {
  const double patches = static_cast<double>(enclosures.enclosure.size());
  const double z = std::sqrt(2 * std::log(patches / significance));
  const double bound = z * enclosures.share_error[patch];
  const double rays = enclosures.share_rays.empty() ? 0 : enclosures.share_rays[patch];
  if (rays == 0 || enclosures.enclosure_closed[enclosures.enclosure[patch]]) return bound;
  return std::max(bound, wilson_reach(enclosures.open_share[patch] + enclosures.back_share[patch], rays, z));
}

}  // namespace luxel
