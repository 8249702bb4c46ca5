// A memory that is too small for all else that is configured, and that
// MachineDesign::fit_memories() would size.
#pragma once

#include "algorithm/files/input_error.h"

namespace sgs {

class MemoryTooSmall : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace sgs
