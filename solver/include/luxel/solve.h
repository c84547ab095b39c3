#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "luxel/transport_operator.h"
#include "luxel/vector.h"

namespace luxel {

enum class Method {
  automatic,
  cholesky,
  lu,
  cg,
  gmres,
  neumann,
  gauss_seidel,
  symmetric_gauss_seidel,
  southwell
};

/// "cholesky", "lu", "cg", ... as on the command line; "jacobi" is read as neumann.
std::string_view name(Method method);
std::optional<Method> method_from_name(std::string_view name);

/// Why an iteration ended.
enum class Stopped {
  converged,   ///< the stopping rule holds
  bounces,     ///< as many bounces as asked were done
  iterations,  ///< max_iterations reached
  diverged,    ///< the residual grew, or is not a number
  stagnated,   ///< no progress over a window, at rounding or worse
  caller       ///< on_iteration returned false
};

/// One line of an iteration's history, handed to on_iteration and kept in the report. One iteration is one
/// application of F to all right-hand sides (for southwell: as many shots as there are patches).
struct Iteration {
  int number = 0;                ///< from 0: the start
  double relative_residual = 0;  ///< area-weighted ||E - B + K B|| / ||E||, worst channel
  double error_bound =
      std::numeric_limits<double>::infinity();  ///< as in SolveReport; infinity where there is none
  const PatchField* radiosity =
      nullptr;  ///< the present B, N x m; valid during the call only; null where not at hand
};

struct SolveOptions {
  Method method = Method::automatic;
  double tolerance = 1e-6;      ///< stop when the relative residual is below, worst channel; > 0
  std::optional<double> error;  ///< stop instead when error_bound is below; > 0
  int max_iterations = 10'000;  ///< >= 1
  std::optional<int> bounces;   ///< neumann only: stop after so many bounces, >= 0
  int restart = 30;             ///< gmres: directions kept
  std::function<bool(const Iteration&)> on_iteration;  ///< returning false stops with Stopped::caller
};

/// What a solve did, and a bound of the algebraic error (not of the operator's).
struct SolveReport {
  Method method = Method::automatic;
  Stopped stopped = Stopped::converged;
  bool converged = false;
  int iterations = 0;            ///< the most over channels
  int refinements = 0;           ///< steps of iterative refinement, for direct methods
  double relative_residual = 0;  ///< measured anew in float64 at the end; 0 where E = 0
  /// Upper bound of max |B - B*| / max |B*| over patches and channels, B* the exact solution for this
  /// operator:
  /// ||r||_inf / (1 - max_i rho_i s_i), or a sharper one; infinity where there is none.
  double error_bound = std::numeric_limits<double>::infinity();
  double condition_estimate = 0;   ///< of the symmetric system, from Lanczos; 0 where not estimated
  std::string message;             ///< one sentence: why no bound, why it did not converge; else empty
  std::vector<Iteration> history;  ///< radiosity pointers are null
};

/// Radiosity and irradiance, both N x m [W/m2], with how they were found.
struct RadiositySolution {
  PatchField radiosity;
  PatchField irradiance;  ///< H = F B
  SolveReport report;
};

/// The system has no unique solution: an enclosure that loses no light has emission (or rho = 1 with none to
/// fix the level). The message names the enclosure by its first patch.
class SingularSystem : public std::runtime_error {
 public:
  SingularSystem(int patch, int channel, bool emits);

  int patch() const { return patch_; }      ///< the first of the enclosure
  int channel() const { return channel_; }  ///< in which nothing is lost
  bool emits() const { return emits_; }     ///< the enclosure has emission in that channel

 private:
  int patch_, channel_;
  bool emits_;
};

/// Solves B = E + rho F B for m channels at once.
/// @param reflectance  N x m, in [0, 1]
/// @param emission     N x m, finite, >= 0
/// @throws SingularSystem; std::invalid_argument for shapes, ranges, or a method that the operator does not
/// allow
///         (cholesky and cg need a symmetric one, cholesky, lu, gauss-seidel and southwell its entries)
RadiositySolution solve(const TransportOperator& transport, const PatchField& reflectance,
                        const PatchField& emission, const SolveOptions& options = {});

/// Where the light goes, per channel [W].
struct Energy {
  Eigen::RowVectorXd emitted;   ///< sum A_i E_i
  Eigen::RowVectorXd absorbed;  ///< sum A_i (1 - rho_i) H_i
  Eigen::RowVectorXd escaped;   ///< sum A_i B_i (1 - s_i)
  double imbalance = 0;  ///< largest |emitted - absorbed - escaped| / emitted over channels with emission
};

Energy energy(const TransportOperator& transport, const PatchField& reflectance, const PatchField& emission,
              const RadiositySolution& solution);

}  // namespace luxel
