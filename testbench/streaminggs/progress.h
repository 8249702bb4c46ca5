// Progress of long work, on a terminal only.
#pragma once

#include "algorithm/vq/codebooks.h"

namespace sgs {

// Rewrites one line of stderr after each iteration; does nothing where stderr is no terminal.
VqProgress quantisation_progress();

}  // namespace sgs
