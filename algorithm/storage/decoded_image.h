// Every record of a memory image decoded, and refused where it could not have been encoded.
#pragma once

#include <string>

#include "algorithm/memory/memory_image.h"
#include "algorithm/splat/gaussian.h"

namespace sgs {

// The stored Gaussians as the units decode them, by slot. source: what errors name. Throws
// InputError for a codebook or record that the units must not be given: an index beyond its
// codebook, a scale beyond the largest one, a rotation that is none, an opacity outside [0, 1], a
// value that is not finite.
ActivatedCloud decode_image(const MemoryImage& image, const std::string& source);

}  // namespace sgs
