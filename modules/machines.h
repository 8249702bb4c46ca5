// The factory: every machine that can be built, a line each.
#pragma once

#include <vector>

#include "modules/machine_design.h"

namespace sgs {

// The first is the default: the exact machine.
const std::vector<MachineKind>& machine_kinds();

}  // namespace sgs
