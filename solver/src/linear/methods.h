#pragma once

#include "linear/iteration_watch.h"

namespace luxel {

// Every method takes the system, a B to start from (N x m, equal to E where rho = 0), and the watch that it
// reports each iteration to; it returns the B at which the watch said stop. The residual that it reports may
// come from a recurrence: solve() measures it anew and calls again with the B returned if rounding has misled
// it.
//
// To add one more: a file beside these, a line here, a value in Method, a line in method.cpp and in
// solve.cpp.

/// B <- E + K B: each iteration adds one bounce of light. Residual 1 apply an iteration, falls by max rho s
/// or better.
PatchField neumann(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch);

/// Exactly `bounces` bounces from B = E.
PatchField neumann_bounces(const RadiositySystem& system, int bounces, IterationWatch& watch);

/// Conjugate gradients on the symmetric form (Hestenes and Stiefel 1952), 1 apply an iteration.
PatchField cg(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch);

/// Restarted GMRES (Saad and Schultz 1986), for operators that are not symmetric, 1 apply an iteration.
PatchField gmres(const RadiositySystem& system, PatchField radiosity, int restart, IterationWatch& watch);

/// Gauss-Seidel sweeps over the patches in order; `symmetric` adds a sweep back to each.
PatchField gauss_seidel(const RadiositySystem& system, PatchField radiosity, bool symmetric,
                        IterationWatch& watch);

/// Progressive shooting: the patch with the most unshot power shoots next.
PatchField southwell(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch);

/// Tiled Cholesky factorisation of the symmetric form, then iterative refinement.
PatchField cholesky(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch);

/// LU factorisation with partial pivoting, then iterative refinement.
PatchField lu(const RadiositySystem& system, PatchField radiosity, IterationWatch& watch);

}  // namespace luxel
