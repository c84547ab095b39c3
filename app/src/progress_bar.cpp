#include "progress_bar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

#include "interruption.h"

namespace luxel::app {

namespace {

// Stages shorter than this are over before one has read about them.
constexpr std::chrono::seconds silent_time{1};

// Ten times a second looks steady and costs nothing.
constexpr std::chrono::milliseconds redraw_time{100};

constexpr int bar_width = 24;  // characters

std::string rate_text(double rate) {
  if (rate >= 1e6) return fmt::format("{:.1f} M/s", rate / 1e6);
  if (rate >= 1e3) return fmt::format("{:.1f} k/s", rate / 1e3);
  return fmt::format("{:.3g} /s", rate);
}

}  // namespace

ProgressBar::ProgressBar(bool shown)
    : shown_(shown && isatty(STDERR_FILENO) != 0), colour_(std::getenv("NO_COLOR") == nullptr) {}

ProgressBar::~ProgressBar() {
  clear();
}

bool ProgressBar::operator()(std::string_view stage, double done, double total) {
  if (interruption_requested()) return false;
  if (!shown_) return true;
  const auto now = Clock::now();
  if (stage != stage_) {
    clear();
    stage_ = stage;
    stage_start_ = now;
    last_drawn_ = {};
  }
  const auto elapsed = now - stage_start_;
  if (elapsed < silent_time || now - last_drawn_ < redraw_time) return true;

  const double seconds = std::chrono::duration<double>(elapsed).count();
  const double share = std::clamp(done / total, 0.0, 1.0);
  const int filled = static_cast<int>(share * bar_width);
  const double left = share > 0 ? seconds * (1 - share) / share : 0;
  const std::string line = fmt::format(
      "{:<14} {}{}{}{} {:3.0f} %  {}  {}:{:02} left", stage_, colour_ ? "\033[36m" : "",
      std::string(filled, '='), std::string(bar_width - filled, '.'), colour_ ? "\033[0m" : "", 100 * share,
      rate_text(done / seconds), static_cast<long>(left) / 60, static_cast<long>(left) % 60);
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  drawn_ = true;
  last_drawn_ = now;
  return true;
}

void ProgressBar::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace luxel::app
