#pragma once

#include <atomic>
#include <mutex>
#include <string_view>

#include "luxel/input_error.h"
#include "luxel/progress.h"

namespace luxel {

/// Progress of a stage that many threads work on: serialises the calls, thins them out, and remembers a wish
/// to stop.
class StageProgress {
 public:
  /// `total` in the stage's own unit, > 0.
  StageProgress(const Progress& progress, std::string_view stage, double total)
      : progress_(progress), stage_(stage), total_(total) {}

  /// Counts `amount` more as done.
  void add(double amount) {
    if (!progress_) return;
    const std::scoped_lock lock(mutex_);
    done_ += amount;
    // a few hundred calls a stage
    if (done_ - told_ < total_ / 256 && done_ < total_) return;
    told_ = done_;
    if (!progress_(stage_, done_, total_)) cancelled_ = true;
  }

  /// Whether blocks that have not begun should not.
  bool cancelled() const { return cancelled_; }

  /// To be called when the blocks have ended. @throws Cancelled
  void finish() const {
    if (cancelled_) throw Cancelled();
  }

 private:
  const Progress& progress_;
  std::string_view stage_;
  double total_;
  double done_ = 0, told_ = 0;
  std::mutex mutex_;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace luxel
