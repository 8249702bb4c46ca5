// Points with colours as a PLY file: what nerfstudio keeps of structure from motion.
#pragma once

#include <string>
#include <vector>

#include "algorithm/dataset/dataset.h"

namespace sgs {

// Reads x y z of any type and red green blue as uchar of the element `vertex`, which comes first,
// in text or binary of either byte order; other properties and what follows are skipped. Throws
// InputError: not a PLY, another element first, a property that is missing, a list or of another
// type, a file cut off, a number that is none or too large.
std::vector<SfmPoint> read_points_ply(const std::string& path);

}  // namespace sgs
