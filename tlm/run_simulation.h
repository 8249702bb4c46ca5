// Time begins.
#pragma once

#include <systemc>

namespace sgs {

// sc_start() until nothing can happen any more. Afterwards exceptions may be thrown as anywhere
// else, also where AddressSanitizer looks on.
void run_simulation();

// The same until this time: what happens then is yet to come.
void run_simulation_until(const sc_core::sc_time& time);

}  // namespace sgs
