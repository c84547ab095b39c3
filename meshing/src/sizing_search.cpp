#include "sizing_search.h"

#include <cmath>
#include <limits>

namespace luxel {

namespace {

// How near the number of patches must come to what is asked, relative: a fifth of what is promised.
constexpr double count_tolerance = 0.01;

// Trials that the search for an edge length may take; the count is no smooth function of it for few patches.
constexpr int trials = 12;

// How near it must come with one edge length for all parts, before some take a finer one: patches of even
// size are worth more than a nearer count.
constexpr double even_tolerance = 0.02;

// How often the share of those parts is halved.
constexpr int mix_trials = 16;

class SizingSearch {
 public:
  SizingSearch(SizedMesher& mesher, double n) : mesher_(mesher), n_(n) {}

  Sizing from(double guess) {
    double low = 0;  // gives too many
    double high = std::numeric_limits<double>::infinity();
    double edge_length = guess;
    for (int trial = 0; trial < trials; ++trial) {
      const double found = count({edge_length, edge_length, 0});
      if (best_error_ <= count_tolerance) return best_;
      (found > n_ ? low : high) = edge_length;
      double next = edge_length * std::sqrt(found / n_);
      // Past the middle the count goes in steps: the step is enclosed by halving.
      const bool enclosed = low > 0 && std::isfinite(high);
      if (!(next > low && next < high) || (enclosed && trial >= trials / 2)) {
        next = std::isfinite(high) ? 0.5 * (low + high) : 2 * low;
      }
      edge_length = next;
    }
    if (best_error_ <= even_tolerance) return best_;
    if (low > 0 && std::isfinite(high)) mix(high, low);
    trim();
    return best_;
  }

 private:
  double count(const Sizing& sizing) {
    const double found = mesher_.count(sizing);
    const double error = std::abs(found / n_ - 1);
    if (error < best_error_) {
      best_error_ = error;
      best_ = sizing;
    }
    return found;
  }

  /// Between two lengths of which one gives too few patches and the other too many.
  void mix(double edge_length, double finer) {
    double few = 0;
    double many = 1;
    for (int trial = 0; trial < mix_trials && best_error_ > count_tolerance; ++trial) {
      const double share = 0.5 * (few + many);
      (count({edge_length, finer, share}) > n_ ? many : few) = share;
    }
  }

  /// The best sizing with edges divided a little more or less.
  void trim() {
    Sizing trimmed = best_;
    const double sign = mesher_.count(trimmed) < n_ ? 1 : -1;
    double small = 0;
    double large = 1;
    trimmed.trim = sign;
    for (int trial = 0; trial < mix_trials && best_error_ > count_tolerance; ++trial) {
      const bool enough = (count(trimmed) > n_) == (sign > 0);
      if (!enough && trial == 0) return;  // all edges together do not do it
      (enough ? large : small) = std::abs(trimmed.trim);
      trimmed.trim = sign * 0.5 * (small + large);
    }
  }

  SizedMesher& mesher_;
  double n_;
  Sizing best_;
  double best_error_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Sizing find_sizing(SizedMesher& mesher, double guess, double n) {
  return SizingSearch(mesher, n).from(guess);
}

}  // namespace luxel
