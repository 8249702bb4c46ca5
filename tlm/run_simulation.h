// Time begins.
#pragma once

namespace sgs {

// sc_start() until nothing can happen any more. Afterwards exceptions may be thrown as anywhere
// else, also where AddressSanitizer looks on.
void run_simulation();

}  // namespace sgs
