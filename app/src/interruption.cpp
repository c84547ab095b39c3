#include "interruption.h"

#include <csignal>

namespace luxel::app {

namespace {

// a signal handler can reach nothing but a variable of this kind
volatile std::sig_atomic_t requested = 0;

void request(int) {
  requested = 1;
}

}  // namespace

void watch_for_interruption() {
  struct sigaction action = {};
  action.sa_handler = request;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interruption_requested() {
  return requested != 0;
}

}  // namespace luxel::app
