#include <algorithm>
#include <stdexcept>
#include <utility>

#include "luxel/plan.h"
#include "plan/decisions.h"
#include "plan/independent_groups.h"
#include "plan/solved_channels.h"

namespace luxel {

namespace {

// 4,000 patches are 64 MB in float64, less than the libraries and the patches themselves take at that size.
constexpr int small_system = 4000;

// Row sums of float32 entries are off by 3e-8 RMS and up to 1e-7 (measured at 10,000 patches).
constexpr double float32_accuracy = 2e-7;

// Groups smaller than this share of the patches are put together up to that size, so that a mesh of thousands
// of crumbs does not make thousands of systems. What that costs is at most 1/64 of the pairs.
constexpr int most_systems = 64;

/// Channels of the patches in which nothing is absorbed and nothing escapes.
std::vector<char> lossless_channels(const PatchField& reflectance, const std::vector<int>& patches,
                                    bool closed) {
  std::vector<char> lossless(reflectance.cols(), closed);
  for (Eigen::Index c = 0; closed && c < reflectance.cols(); ++c) {
    lossless[c] = std::all_of(patches.begin(), patches.end(),
                              [&](int i) { return reflectance(i, c) >= 1 - smallest_loss; });
  }
  return lossless;
}

bool any(const std::vector<char>& flags) {
  return std::find(flags.begin(), flags.end(), 1) != flags.end();
}

bool emits(const PatchField& emission, const std::vector<int>& patches) {
  return std::any_of(patches.begin(), patches.end(),
                     [&](int i) { return (emission.row(i).array() > 0).any(); });
}

class Planner {
 public:
  Planner(const PatchMesh& mesh, const Enclosures& enclosures, const PlanOptions& options)
      : mesh_(mesh),
        enclosures_(enclosures),
        options_(options),
        reflectance_(reflectance(mesh)),
        emission_(emission(mesh)) {
    plan_.patches = mesh.size();
    plan_.keep_idle_occluders = !options.savings.idle_occluders;
  }

  Plan make() {
    if (options_.everything) {
      add_system(everyone(), enclosures_.closed);
    } else {
      choose_groups();
    }
    tell();
    return std::move(plan_);
  }

 private:
  std::vector<int> everyone() const {
    std::vector<int> all(mesh_.size());
    for (int i = 0; i < mesh_.size(); ++i) all[i] = i;
    return all;
  }

  void choose_groups() {
    const Savings& savings = options_.savings;
    if (!savings.dark_enclosures && !savings.separate_enclosures)
      return add_system(everyone(), enclosures_.closed);
    const PatchGroups groups = independent_groups(mesh_, enclosures_);
    std::vector<int> lit, crumbs;
    bool lit_closed = true, crumbs_closed = true;
    for (std::size_t g = 0; g < groups.patches.size(); ++g) {
      const std::vector<int>& patches = groups.patches[g];
      const bool closed = groups.closed[g];
      if (savings.dark_enclosures && leave_dark(patches, closed)) continue;
      if (savings.separate_enclosures && leave_alone(patches)) continue;
      if (!savings.separate_enclosures || options_.together) {
        lit.insert(lit.end(), patches.begin(), patches.end());
        lit_closed &= closed;
      } else if (static_cast<int>(patches.size()) * most_systems >= mesh_.size()) {
        add_system(patches, closed);
      } else {
        crumbs.insert(crumbs.end(), patches.begin(), patches.end());
        crumbs_closed &= closed;
        if (static_cast<int>(crumbs.size()) * most_systems < mesh_.size()) continue;
        add_system(std::exchange(crumbs, {}), std::exchange(crumbs_closed, true));
      }
    }
    if (!crumbs.empty()) add_system(std::move(crumbs), crumbs_closed);
    if (!lit.empty()) add_system(std::move(lit), lit_closed);
  }

  bool leave_dark(const std::vector<int>& patches, bool closed) {
    if (emits(emission_, patches)) return false;
    if (!options_.solve.bounces && any(lossless_channels(reflectance_, patches, closed))) return false;
    ++dark_groups_;
    dark_patches_ += static_cast<int>(patches.size());
    return true;
  }

  bool leave_alone(const std::vector<int>& patches) {
    if (patches.size() > 1) return false;
    ++lone_patches_;
    return true;
  }

  void add_system(std::vector<int> patches, bool closed) {
    const Savings& savings = options_.savings;
    SystemPlan system;
    std::sort(patches.begin(), patches.end());
    const int size = static_cast<int>(patches.size());
    system.closed = closed;
    system.channels = channels(patches, closed);
    system.precision =
        savings.precision ? storage_precision(size, options_.form_factors.accuracy) : Precision::float64;
    system.method = options_.solve.method;
    if (!savings.method && system.method == Method::automatic && !options_.solve.bounces)
      system.method = Method::cg;
    system.polygons = system.hiding_polygons = mesh_.occluders.polygon_count;
    if (savings.idle_occluders && !options_.everything) {
      const PatchMesh part = sub_mesh(mesh_, patches, closed);
      system.hiding_polygons = hiding_polygons(part);
      system.polygons = part.occluders.polygon_count;
    }
    system.patches = std::move(patches);
    plan_.systems.push_back(std::move(system));
  }

  ChannelPlan channels(const std::vector<int>& patches, bool closed) const {
    const Eigen::Index count = emission_.cols();
    if (options_.savings.channels) {
      std::vector<char> lossless(count, 0);
      if (!options_.solve.bounces) lossless = lossless_channels(reflectance_, patches, closed);
      return plan_channels(reflectance_(patches, Eigen::all), emission_(patches, Eigen::all), lossless);
    }
    return every_channel(static_cast<int>(count));
  }

  void tell() {
    std::vector<LeftOut>& told = plan_.left_out;
    const std::vector<SystemPlan>& systems = plan_.systems;
    note(told, dark_groups(dark_groups_, dark_patches_, mesh_.size()));
    note(told, lone_patches(lone_patches_));
    note(told, pairs_between(systems));
    note(told, left_rays(systems));
    note(told, idle_occluders(systems));
    if (!options_.savings.channels) return;
    note(told, dark_channels(systems));
    note(told, equal_channels(systems));
    note(told, black_patches(reflectance_));
  }

  const PatchMesh& mesh_;
  const Enclosures& enclosures_;
  const PlanOptions& options_;
  PatchField reflectance_, emission_;
  Plan plan_;
  int dark_groups_ = 0, dark_patches_ = 0, lone_patches_ = 0;
};

}  // namespace

Precision storage_precision(int patches, double accuracy) {
  return patches <= small_system || accuracy < float32_accuracy ? Precision::float64 : Precision::float32;
}

Plan make_plan(const PatchMesh& mesh, const Enclosures& enclosures, const PlanOptions& options) {
  if (static_cast<int>(enclosures.enclosure.size()) != mesh.size()) {
    throw std::invalid_argument("make_plan: enclosures need one entry for each patch");
  }
  return Planner(mesh, enclosures, options).make();
}

Enclosures planned_enclosures(const PatchMesh& mesh, const PlanOptions& options, const Progress& progress) {
  constexpr int rays_per_patch = 256;
  if (!options.savings.idle_occluders || !convex_inside(mesh)) {
    return find_enclosures(mesh, RayScene(mesh.occluders), rays_per_patch, progress);
  }
  return one_closed_enclosure(mesh.size());
}

}  // namespace luxel
