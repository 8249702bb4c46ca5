// Compares the on-chip memory that a machine's data sheets take with the bytes that stand there.
#pragma once

#include "modules/machine.h"

namespace sgs {

// To be called once a machine is built, before its time begins. Throws InputError, with the sum,
// for a memory of which more is taken than there is; std::logic_error, with the name, for a queue
// whose entries are in none of its unit's uses.
void check_sram_budget(Machine& machine);

}  // namespace sgs
