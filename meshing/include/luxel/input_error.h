#pragma once

#include <stdexcept>
#include <string>

namespace luxel {

/// The user's input cannot be used. The message is one line that names file, line (where there is one) and
/// item, says what was found and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's Progress callback asked to stop; nothing was written.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace luxel
