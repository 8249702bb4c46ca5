// Keeps SystemC's copyright banner out of the output of an executable that includes this.
#pragma once

#include <cstdlib>

namespace sgs {

// The kernel prints it before sc_main begins, unless the variable is set by then.
inline const int kNoBanner = ::setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 0);

}  // namespace sgs
