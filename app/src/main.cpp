#include <cstdio>
#include <string>

#include "command_line.h"
#include "exit_status.h"
#include "interruption.h"
#include "run_command.h"

int main(int argc, char** argv) {
  using namespace luxel::app;
  watch_for_interruption();
  try {
    return run_command(parse_command_line(argc, argv));
  } catch (...) {
    const Failure failure = describe_failure(std::current_exception());
    std::fprintf(stderr, "luxel: %s\n", failure.message.c_str());
    return failure.status;
  }
}
