#include "luxel/hierarchical_operator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "transport/hierarchical/block_assembly.h"
#include "transport/hierarchical/brightness.h"
#include "transport/hierarchical/build_operator.h"
#include "transport/row_scaling.h"

namespace luxel {

namespace {

// A point receives light through hundreds of blocks, the more the smaller the error that each may have, and
// their errors have either sign: for an accuracy A each may err by A^1.5 times this. Measured; see
// docs/decisions/0014-hierarchical.md.
constexpr double block_share = 1;
double block_error(double accuracy) {
  return block_share * std::pow(accuracy, 1.5);
}

// The first operator, which only tells how bright clusters are, is this much coarser, and never finer than
// the second number.
constexpr double first_coarsening = 10;
constexpr double finest_first = 0.02;

// Row error that scaling may leave, as a share of the accuracy; the rest, up to it, goes to the diagonal.
constexpr double closed_share = 0.01;

void check(const PatchMesh& mesh, const Enclosures& enclosures, const PatchField& reflectance,
           const PatchField& emission, const HierarchicalOptions& options) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument("hierarchical_operator: " + message);
  };
  require(options.accuracy >= 1e-4 && options.accuracy <= 0.3, "accuracy must lie in [1e-4, 0.3]");
  require(static_cast<int>(enclosures.enclosure.size()) == mesh.size(), "enclosures are of another mesh");
  require(reflectance.rows() == mesh.size() && emission.rows() == mesh.size() &&
              reflectance.cols() == emission.cols(),
          "reflectance and emission need one row for each patch and the same columns");
}

using Impl = HierarchicalOperator::Impl;

HidingScene hiding_scene(const PatchMesh& mesh, const WorkingFrame& frame) {
  HidingScene scene;
  scene.occluders = occluder_set(mesh, frame);
  if (!scene.occluders.occluders.empty()) scene.rays = std::make_unique<OccluderScene>(scene.occluders);
  return scene;
}

/// The operator over these blocks, not closed.
std::unique_ptr<Impl> operator_of(const PatchHierarchy& hierarchy, std::vector<BlockList> lists) {
  ActiveTree tree = active_tree(hierarchy, lists);
  NodeInterpolation interpolation(hierarchy, tree);
  HierarchicalReport report;
  for (const BlockList& list : lists) {
    report.entries += list.entries;
    report.blocks += static_cast<std::int64_t>(list.size()) - list.entries;
    report.unhidden += list.unhidden;
    report.hidden += list.hidden;
    report.rays += list.rays;
  }
  const double square = hierarchy.frame.scale * hierarchy.frame.scale;
  std::vector<double> working_areas = interpolation.node_areas();
  for (double& area : working_areas) area *= square;
  report.clusters = hierarchy.cluster_count();
  report.unknowns = interpolation.unknowns();
  std::vector<double> areas = interpolation.node_areas();
  auto impl = std::make_unique<Impl>(
      std::move(interpolation),
      CoarseOperator(BlockProduct(std::move(tree), std::move(lists), std::move(working_areas)),
                     std::move(areas)));
  impl->report = report;
  return impl;
}

/// Row sums of the patches.
std::vector<double> patch_row_sums(const Impl& impl) {
  std::vector<double> sums(impl.interpolation.patches());
  impl.interpolation.to_patches(impl.coarse.row_sums().data(), sums.data(), 1);
  return sums;
}

void close(Impl& impl, const Enclosures& enclosures, double accuracy, const Progress& progress) {
  CoarseOperator& coarse = impl.coarse;
  const std::vector<int> patches = impl.interpolation.patch_of_unknowns();
  std::vector<int> enclosure(patches.size());
  std::vector<char> active(patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    enclosure[i] = enclosures.enclosure[patches[i]];
    active[i] = enclosures.enclosure_closed[enclosure[i]] && coarse.row_sums()[i] > 0;
  }
  const SymmetricProduct product = [&](const double* x, double* y) {
    coarse.apply(x, y, 1);
    for (std::size_t i = 0; i < patches.size(); ++i) y[i] *= coarse.areas()[i];
  };
  ClosureReport& report = impl.report.closure;
  RowClosure closure = close_enclosures(product, coarse.areas(), enclosure, std::move(active),
                                        closed_share * accuracy, progress);
  report.iterations = closure.iterations;
  if (closure.unclosed >= 0) {
    report.unclosed = patches[closure.unclosed];
    report.message = unclosed_message(report.unclosed);
  }
  if (std::find(closure.closed.begin(), closure.closed.end(), 1) == closure.closed.end()) return;
  report.applied = true;
  coarse.close(std::move(closure.factors), closure.closed);
  report.largest_correction = coarse.largest_correction();
}

std::unique_ptr<HierarchicalOperator> finished(std::unique_ptr<Impl> impl, const Enclosures& enclosures,
                                               double accuracy, const Progress& progress) {
  ClosureReport& report = impl->report.closure;
  const std::vector<double>& areas = impl->interpolation.areas();
  impl->row_sums = patch_row_sums(*impl);
  report.before = report.after = row_sum_error(impl->row_sums, areas, enclosures);
  close(*impl, enclosures, accuracy, progress);
  if (report.applied) {
    impl->row_sums = patch_row_sums(*impl);
    report.after = row_sum_error(impl->row_sums, areas, enclosures);
  }
  return std::make_unique<HierarchicalOperator>(std::move(impl));
}

}  // namespace

std::unique_ptr<HierarchicalOperator> hierarchical_operator(
    const PatchMesh& mesh, const Enclosures& enclosures, const PatchField& reflectance,
    const PatchField& emission, const HierarchicalOptions& options, const Progress& progress) {
  check(mesh, enclosures, reflectance, emission, options);
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures);
  const HidingScene scene = hiding_scene(mesh, hierarchy.frame);

  AssemblyOptions assembly{options.accuracy, block_error(options.accuracy), options.seed};
  Brightness brightness = guessed_brightness(hierarchy, reflectance, emission);
  const double first_error = std::max(first_coarsening * options.accuracy, finest_first);
  {
    AssemblyOptions loose = assembly;
    loose.accuracy = first_error;
    loose.block_error = block_error(first_error);
    const auto first = operator_of(hierarchy, assemble_blocks(hierarchy, scene, brightness, loose, progress));
    brightness = solved_brightness(hierarchy, first->interpolation, first->coarse, reflectance, emission);
  }
  auto impl = operator_of(hierarchy, assemble_blocks(hierarchy, scene, brightness, assembly, progress));
  for (const Occluder& occluder : scene.occluders.occluders) {
    impl->report.occluders += occluder.face_count();
  }
  return finished(std::move(impl), enclosures, options.accuracy, progress);
}

std::unique_ptr<HierarchicalOperator> hierarchical_operator(const PatchMesh& mesh,
                                                            const Enclosures& enclosures,
                                                            const HierarchicalOptions& options,
                                                            const Progress& progress) {
  check(mesh, enclosures, PatchField(mesh.size(), 1), PatchField(mesh.size(), 1), options);
  const PatchHierarchy hierarchy = patch_hierarchy(mesh, enclosures);
  const HidingScene scene = hiding_scene(mesh, hierarchy.frame);
  const AssemblyOptions assembly{options.accuracy, block_error(options.accuracy), options.seed};
  auto impl = operator_of(
      hierarchy, assemble_blocks(hierarchy, scene, uniform_brightness(hierarchy), assembly, progress));
  for (const Occluder& occluder : scene.occluders.occluders) {
    impl->report.occluders += occluder.face_count();
  }
  return finished(std::move(impl), enclosures, options.accuracy, progress);
}

HierarchicalOperator::HierarchicalOperator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  impl_->report.bytes = bytes();
}
HierarchicalOperator::~HierarchicalOperator() = default;

int HierarchicalOperator::size() const {
  return impl_->interpolation.patches();
}

std::span<const double> HierarchicalOperator::row_sums() const {
  return impl_->row_sums;
}

std::span<const double> HierarchicalOperator::areas() const {
  return impl_->interpolation.areas();
}

std::size_t HierarchicalOperator::bytes() const {
  return impl_->interpolation.bytes() + impl_->coarse.bytes() + impl_->row_sums.size() * sizeof(double);
}

const HierarchicalReport& HierarchicalOperator::report() const {
  return impl_->report;
}

const TransportOperator& HierarchicalOperator::coarse() const {
  return impl_->coarse;
}

void HierarchicalOperator::apply(const double* x, double* y, int columns) const {
  PatchField light(impl_->interpolation.unknowns(), columns), irradiance(light.rows(), columns);
  impl_->interpolation.to_nodes(x, light.data(), columns);
  impl_->coarse.apply(light.data(), irradiance.data(), columns);
  impl_->interpolation.to_patches(irradiance.data(), y, columns);
}

PatchField HierarchicalOperator::restrict(const PatchField& patches) const {
  if (patches.rows() != size()) throw std::invalid_argument("restrict: one row for each patch");
  PatchField nodes(impl_->interpolation.unknowns(), patches.cols());
  impl_->interpolation.to_nodes(patches.data(), nodes.data(), static_cast<int>(patches.cols()));
  return nodes;
}

PatchField HierarchicalOperator::expand(const PatchField& nodes) const {
  if (nodes.rows() != impl_->interpolation.unknowns()) {
    throw std::invalid_argument("expand: one row for each coarse node");
  }
  PatchField patches(size(), nodes.cols());
  impl_->interpolation.to_patches(nodes.data(), patches.data(), static_cast<int>(nodes.cols()));
  return patches;
}

}  // namespace luxel
