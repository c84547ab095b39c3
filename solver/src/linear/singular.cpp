#include "linear/singular.h"

#include <string>

#include "luxel/solve.h"

namespace luxel {

namespace {

// Rows of closed operators are right to 1e-12; a loss below this cannot be told from none.
constexpr double smallest_loss = 1e-11;

/// Adds to the marked patches (1, others 0) all that see one of them, over any number of bounces.
PatchField spread(const RadiositySystem& system, PatchField marked) {
  Eigen::Index before = 0;
  for (Eigen::Index now = (marked.array() != 0).count(); now > before && now < marked.size();) {
    const PatchField seen = system.apply(marked);
    marked = ((marked.array() != 0) || (seen.array() != 0)).cast<double>();
    before = now;
    now = (marked.array() != 0).count();
  }
  return marked;
}

SingularSystem refusal(const RadiositySystem& system, Eigen::Index patch, Eigen::Index channel) {
  PatchField mark = PatchField::Zero(system.size(), 1);
  mark(patch, 0) = 1;
  const PatchField enclosure = spread(system, mark);
  const bool emits = (enclosure.col(0).array() * system.emission().col(channel).array() > 0).any();
  return {static_cast<int>(patch), static_cast<int>(channel), emits};
}

}  // namespace

SingularSystem::SingularSystem(int patch, int channel, bool emits)
    : std::runtime_error("the system is singular: the enclosure of patch " + std::to_string(patch) +
                         " is closed and reflects everything (channel " + std::to_string(channel) +
                         "), so that its " +
                         (emits ? "emission can never be absorbed" : "radiosity is not unique")),
      patch_(patch),
      channel_(channel),
      emits_(emits) {}

void refuse_singular(const RadiositySystem& system) {
  for (Eigen::Index c = 0; c < system.columns(); ++c) {
    const Eigen::ArrayXd loss = 1 - system.reflectance().col(c).array() * system.row_sums().array();
    if (loss.size() == 0 || loss.minCoeff() > smallest_loss) continue;
    const PatchField losing = (loss.abs() > smallest_loss).cast<double>().matrix();
    const PatchField regular = spread(system, losing);
    for (Eigen::Index i = 0; i < system.size(); ++i) {
      if (regular(i, 0) == 0) throw refusal(system, i, c);
    }
  }
}

}  // namespace luxel
