#include <algorithm>
#include <stdexcept>

#include "luxel/group_factors.h"

namespace luxel {

namespace {

// Indicator columns that go through the operator together: as many as its own passes take.
constexpr int columns_a_pass = 3;

}  // namespace

GroupFactors group_form_factors(const TransportOperator& transport, std::span<const int> groups, int count) {
  const int size = transport.size();
  if (static_cast<int>(groups.size()) != size || count < 0) {
    throw std::invalid_argument("group_form_factors: groups need one entry for each patch");
  }
  if (std::any_of(groups.begin(), groups.end(), [&](int group) { return group < 0 || group >= count; })) {
    throw std::invalid_argument("group_form_factors: a group is out of range");
  }
  const auto areas = transport.areas();
  GroupFactors result;
  result.areas.assign(count, 0.0);
  for (int i = 0; i < size; ++i) result.areas[groups[i]] += areas[i];
  result.form_factors = Eigen::MatrixXd::Zero(count, count);
  for (int first = 0; first < count; first += columns_a_pass) {
    const int columns = std::min(columns_a_pass, count - first);
    PatchField members = PatchField::Zero(size, columns);
    for (int i = 0; i < size; ++i) {
      if (groups[i] >= first && groups[i] < first + columns) members(i, groups[i] - first) = 1;
    }
    PatchField shares(size, columns);
    transport.apply(members.data(), shares.data(), columns);
    for (int i = 0; i < size; ++i) {
      result.form_factors.row(groups[i]).segment(first, columns) += areas[i] * shares.row(i);
    }
  }
  for (int group = 0; group < count; ++group) {
    if (result.areas[group] > 0) result.form_factors.row(group) /= result.areas[group];
  }
  return result;
}

}  // namespace luxel
