#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace luxel::app {

/// Shows how far a stage is, its rate and the time left, on one line of stderr, for stages that take over a
/// second and only where stderr is a terminal. Also the place where Ctrl-C is noticed.
class ProgressBar {
 public:
  /// @param shown  false: nothing is drawn; interruption is still noticed
  explicit ProgressBar(bool shown);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// luxel::Progress: false once Ctrl-C was pressed.
  bool operator()(std::string_view stage, double done, double total);

 private:
  using Clock = std::chrono::steady_clock;
  void clear();

  bool shown_;
  bool colour_;
  bool drawn_ = false;
  std::string stage_;
  Clock::time_point stage_start_;
  Clock::time_point last_drawn_;
};

}  // namespace luxel::app
