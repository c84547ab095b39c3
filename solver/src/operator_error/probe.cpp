#include "operator_error/probe.h"

#include <algorithm>

#include "luxel/gather_operator.h"
#include "sampling/owen_sobol.h"
#include "transport/gather/lamp_light.h"

namespace luxel {

namespace {

constexpr std::uint64_t lamp_stream = 0x70726f62;

// Lamps that get as many rays each as a look has; more of them share.
constexpr std::size_t few_lamps = 4;
constexpr int least_rays_a_lamp = 64;

int rays_of_lamp(int rays, std::size_t lamps) {
  if (lamps <= few_lamps) return rays;
  return std::max(least_rays_a_lamp, static_cast<int>(rays * few_lamps / lamps));
}

}  // namespace

Probe::Probe(const PatchMesh& mesh, const RayScene& occluders, const GatherRays& rays,
             const PatchField& emission, const PatchField& radiosity, int rays_a_look)
    : mesh_(mesh),
      occluders_(occluders),
      rays_(rays),
      lamps_(gather_plan(mesh, emission).direct_apart ? lamps_of(mesh, emission, occluders)
                                                      : std::vector<Lamp>()),
      field_(PatchField::Zero(mesh.size() + 1, radiosity.cols())),
      net_(rays_a_look),
      rays_a_lamp_(rays_of_lamp(rays_a_look, lamps_.size())),
      shadow_rays_(occluders, rays_a_lamp_) {
  field_.topRows(mesh.size()) = lamps_.empty() ? radiosity : PatchField(radiosity - emission);
}

Probe::Look Probe::look(int patch, std::uint64_t seed) const {
  Look look;
  look.irradiance = Eigen::RowVectorXd::Zero(field_.cols());
  std::vector<std::uint32_t> met(net_.count());
  rays_.trace_patch(patch, net_, seed, met.data());
  int found = 0;
  for (const std::uint32_t end : met) {
    look.irradiance += field_.row(end);
    found += end != static_cast<std::uint32_t>(mesh_.size());
  }
  look.irradiance /= net_.count();
  look.row_sum = static_cast<double>(found) / net_.count();
  look.rays = net_.count();

  const PatchFrame frame = patch_frame(mesh_, patch, occluders_);
  const double area = mesh_.areas[patch] * occluders_.scale() * occluders_.scale();
  for (std::size_t l = 0; l < lamps_.size(); ++l) {
    if (!faces(frame, lamps_[l])) continue;
    const LampView view =
        shadow_rays_.view(frame, lamps_[l], rays_a_lamp_, mixed_seed(seed ^ lamp_stream ^ l << 32, patch));
    look.rays += view.rays;
    if (view.share > 0) {
      look.irradiance += view.share * unoccluded(frame, area, lamps_[l]) * lamps_[l].emission;
    }
  }
  return look;
}

}  // namespace luxel
