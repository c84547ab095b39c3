#pragma once

#include "luxel/plan.h"
#include "plan/dark_enclosures.h"

// From a run on sub_mesh(mesh, dark.others) to one of the whole mesh.
namespace luxel {

/// The same options; iterations are told with the radiosity of the whole mesh.
/// @param dark  must outlive the result
PlanOptions told_of_all(PlanOptions options, const DarkEnclosures& dark);

/// The light where every enclosure is dark: of no patch.
PlannedSolution light_of_none();

/// Fields with exact zeros in the dark, row sums that are not numbers there, and the patches' own numbers.
void add_dark(PlannedSolution& light, const DarkEnclosures& dark);

/// The same exception with the patch's number in the whole mesh.
SingularSystem singular_among_all(const SingularSystem& singular, const DarkEnclosures& dark);

/// Enclosures of the whole mesh from those of the others.
Enclosures with_dark(const Enclosures& others, const DarkEnclosures& dark);

}  // namespace luxel
