// Configuration and packed scenes: what one must take from the other.
#pragma once

#include <string>
#include <vector>

#include "algorithm/memory/image_file.h"
#include "modules/accelerator_config.h"
#include "modules/auto_config.h"

namespace sgs {

// What a file says of a scene that was stored as `config` (resolved) asks for.
PackedFacts packed_facts(const AcceleratorConfig& config, const MemoryImage& image,
                         const std::string& name, std::uint64_t gaussians,
                         std::uint64_t dropped_invalid);

// Sets what the image of the file `path` decides: encoding, how codebooks were made, which
// Gaussians are stored, size of chunks or voxels; adds to `chosen`. Before resolve(). Throws
// InputError when the configuration's ordering cannot use the image.
void adopt(const PackedScene& packed, const std::string& path, AcceleratorConfig& config,
           std::vector<AutoChoice>& chosen);

}  // namespace sgs
