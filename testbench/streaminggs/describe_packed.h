// Describes the contents of a packed scene, for `pack` and `info`.
#pragma once

#include <string>

#include "algorithm/storage/image_file.h"

namespace sgs {

// Prints a line each: scene, storage order and the machines that read it, encoding, codebooks,
// regions with their bytes. readers: those machines; empty for none.
void print_packed(const PackedFacts& facts, const StorageConfig& storage, const SceneLayout& layout,
                  const std::string& readers);

}  // namespace sgs
