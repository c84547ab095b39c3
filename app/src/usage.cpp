#include "usage.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

namespace luxel::app {

Stopwatch::Stopwatch() : cpu_start_(process_cpu_seconds()), wall_start_(std::chrono::steady_clock::now()) {}

Seconds Stopwatch::elapsed() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - wall_start_;
  return {process_cpu_seconds() - cpu_start_, wall.count()};
}

double process_cpu_seconds() {
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::size_t peak_bytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::size_t machine_bytes() {
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace luxel::app
