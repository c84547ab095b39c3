#include "exit_status.h"

#include <algorithm>
#include <new>

#include "luxel/input_error.h"
#include "luxel/solve.h"

namespace luxel::app {

namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

Failure describe_failure(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Cancelled&) {
    return {interrupted, "stopped; nothing was written"};
  } catch (const InputError& error) {
    return {unusable_input, one_line(error.what())};
  } catch (const SingularSystem& error) {
    return {unusable_input, one_line(error.what())};
  } catch (const std::bad_alloc&) {
    return {unusable_input, "the machine has no more memory; fewer patches (--patches) need less"};
  } catch (const std::exception& error) {
    return {internal_fault, "internal fault: " + one_line(error.what())};
  } catch (...) {
    return {internal_fault, "internal fault of an unknown kind"};
  }
}

}  // namespace luxel::app
