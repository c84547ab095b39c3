#pragma once

#include <chrono>
#include <cstddef>

namespace luxel::app {

/// CPU seconds (user + system, all threads) and wall seconds since some start.
struct Seconds {
  double cpu = 0;
  double wall = 0;
};

/// Measures from its making on.
class Stopwatch {
 public:
  Stopwatch();
  Seconds elapsed() const;

 private:
  double cpu_start_;
  std::chrono::steady_clock::time_point wall_start_;
};

/// CPU seconds of this process since it started.
double process_cpu_seconds();

/// The most memory that this process has held at once so far [bytes].
std::size_t peak_bytes();

/// Memory of the machine [bytes].
std::size_t machine_bytes();

}  // namespace luxel::app
