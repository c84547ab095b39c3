#pragma once

#include <functional>
#include <vector>

#include "linear/iteration_watch.h"

namespace luxel {

/// Entries of a factor: float32 halves time and memory, and refinement with float64 residuals makes it as
/// exact.
enum class FactorPrecision { float32, float64 };

/// Gives an approximation of (I - K)^-1 r for the residual r, N x m.
using Correction = std::function<PatchField(const PatchField& residual)>;

/// Factors the system in one precision; null where it cannot be factored.
using Factorisation = std::function<Correction(FactorPrecision)>;

/// The precision to begin with: float32 where the smallest loss 1 - rho s promises a quick refinement.
FactorPrecision first_precision(const RadiositySystem& system);

/// Iterative refinement (Wilkinson 1963; Higham 2002, ch. 12) with residuals in float64: factors in float32
/// where that is safe, and anew in float64 where refinement does not get on.
PatchField refine(const RadiositySystem& system, PatchField radiosity, const Factorisation& factorise,
                  IterationWatch& watch);

}  // namespace luxel
