#include "form_factors/group_exchange.h"

#include <algorithm>

namespace luxel {

namespace {

template <class Real>
void add_rows(const ExchangeMatrix& unhidden, const std::vector<int>& groups, std::size_t count,
              std::vector<double>& sums) {
  for (int i = 0; i < unhidden.size(); ++i) {
    const Real* entries = unhidden.row<Real>(i);
    double* row = &sums[static_cast<std::size_t>(groups[i]) * count];
    for (int j = 0; j < i; ++j) row[groups[j]] += static_cast<double>(entries[j]);
  }
}

}  // namespace

GroupExchange::GroupExchange(const PatchMesh& mesh, const ClusterTree& tree, const ExchangeMatrix& unhidden,
                             double least_factor)
    : count_(mesh.group_names.size()) {
  std::vector<double> areas(count_);
  for (const WorkPatch& patch : tree.patches) {
    group_.push_back(mesh.groups[patch.patch]);
    areas[group_.back()] += patch.area;
  }
  sums_.resize(count_ * count_);
  if (unhidden.precision() == Precision::float32) {
    add_rows<float>(unhidden, mesh.groups, count_, sums_);
  } else {
    add_rows<double>(unhidden, mesh.groups, count_, sums_);
  }
  for (std::size_t a = 0; a < count_; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      double sum = sums_[a * count_ + b] + (a == b ? 0 : sums_[b * count_ + a]);
      sum = std::max(sum * tree.scale * tree.scale, least_factor * std::min(areas[a], areas[b]));
      sums_[a * count_ + b] = sums_[b * count_ + a] = sum;
    }
  }
}

}  // namespace luxel
