#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace luxel {

/// A figure that was not estimated, or that has no bound: `null` in JSON, "-" in the summary.
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Every figure that a run of Luxel measured, as plain data: the JSON report (docs/outputs.md) field by
/// field. Parts that a command does not have are empty and are left out of the document.
struct Report {
  struct Run {
    std::string version;
    std::string command;  ///< "solve", "factors", ...
    int threads = 0;
  };

  struct Scene {
    std::string file;
    std::int64_t faces = 0;     ///< of the input
    std::int64_t vertices = 0;  ///< of the input
    std::int64_t materials = 0;
    double area = 0;      ///< [m2]
    bool closed = false;  ///< no direction from the front of any patch escapes or meets a back
    int enclosures = 0;
    std::vector<std::string> warnings;
    std::int64_t overlapping_faces = 0;  ///< that an earlier face covers in part on the same side
    double overlap_area = 0;             ///< what is covered of them [m2]
  };

  struct Operator {
    std::string kind;             ///< "dense", "gather" or "hierarchical"
    double accuracy = not_known;  ///< as asked
    std::uint64_t bytes = 0;      ///< held by the operator
    std::int64_t rays = 0;        ///< cast for it
    double cpu_seconds = 0;
    double wall_seconds = 0;
    double row_sum_error_max = not_known;  ///< before any correction
    double row_sum_error_rms = not_known;  ///< area-weighted
    double reciprocity_error = not_known;
    std::string correction = "none";  ///< its kind
    double largest_correction = 0;    ///< largest |factor - 1| that an entry was multiplied by

    /// What each operator would have cost, foretold.
    struct Candidate {
      std::string kind;
      double cpu_seconds = 0;
      std::uint64_t bytes = 0;
      bool fits = true;  ///< into the memory that may be taken
    };
    std::vector<Candidate> candidates;  ///< empty: the operator was asked for by name
  };

  struct HistoryEntry {
    int iteration = 0;
    double wall_seconds = 0;
    double cpu_seconds = 0;
    double relative_residual = not_known;
    double error = not_known;
  };

  struct Solver {
    std::string method;
    int iterations = 0;  ///< the most over channels
    bool converged = false;
    double relative_residual = not_known;
    double error_bound = not_known;
    double condition_estimate = not_known;  ///< of the symmetric system, where conjugate gradients solved it
    double cpu_seconds = 0;
    double wall_seconds = 0;
    std::string message;  ///< one sentence where there is something to say: why there is no bound, ...
    std::vector<HistoryEntry> history;
  };

  struct Energy {
    std::array<double, 3> emitted{};   ///< [W]
    std::array<double, 3> absorbed{};  ///< [W]
    std::array<double, 3> escaped{};   ///< [W]
    double imbalance = not_known;      ///< relative to emitted
  };

  /// Relative; not_known where not estimated.
  struct Error {
    double algebraic = not_known;
    double operator_estimate = not_known;
    double operator_low = not_known;
    double operator_high = not_known;
    double discretisation = not_known;
  };

  struct LeftOut {
    std::string what;
    std::string why;
    std::string saved;
  };

  /// What solving the scene will take, foretold.
  struct Estimate {
    std::string kind;  ///< of the operator that would be chosen
    double cpu_seconds = 0;
    std::uint64_t bytes = 0;  ///< at the peak, the program itself included
  };

  /// Form factors between groups: F_IJ = sum over i in I, j in J of A_i F_ij / A_I.
  struct GroupFactors {
    std::vector<std::string> groups;
    std::vector<double> areas;                      ///< [m2]
    std::vector<std::vector<double>> form_factors;  ///< row by row
    std::vector<double> open;                       ///< share that meets no front
  };

  /// Form factors from a point with a normal to groups.
  struct PointFactors {
    std::array<double, 3> point{};   ///< [m]
    std::array<double, 3> normal{};  ///< unit vector
    std::vector<std::string> groups;
    std::vector<double> form_factors;  ///< one for each group
    double open = 0;                   ///< share that escapes or meets a back
    double error = 0;                  ///< standard error of the largest of these figures; 0: exact
  };

  Run run;
  Scene scene;
  std::int64_t patches = 0;
  std::optional<Operator> transport;  ///< "operator" in JSON
  std::optional<Solver> solver;
  std::optional<Energy> energy;
  std::optional<Error> error;
  std::optional<GroupFactors> group_factors;
  std::optional<PointFactors> point_factors;  ///< "point" in JSON
  std::vector<LeftOut> left_out;
  bool partial = false;  ///< stopped before it was solved: what was written is what was there
  std::optional<Estimate> estimate;
  double cpu_seconds = 0;  ///< user + system of the process
  double wall_seconds = 0;
  std::uint64_t peak_bytes = 0;
};

/// The report as one JSON document that ends in a line break; keys in the order of docs/outputs.md, numbers
/// so that they read back to the same bits, NaN and infinities as null, bytes that are not UTF-8 as U+FFFD.
std::string to_json(const Report& report);

/// The report for a person: a dozen aligned lines with units, each ending in a line break.
std::string summary(const Report& report);

}  // namespace luxel
