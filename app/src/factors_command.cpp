#include "luxel/input_error.h"
#include "run_command.h"

namespace luxel::app {

ExitStatus run(const FactorsCommand&) {
  throw InputError("the command 'factors' is not part of this version");
}

}  // namespace luxel::app
