// What a packed scene holds, for `pack` and `info`.
#pragma once

#include "algorithm/memory/image_file.h"

namespace sgs {

// Prints a line each: scene, storage order, encoding, codebooks, regions with their bytes.
void print_packed(const PackedFacts& facts, const MemoryLayout& layout);

}  // namespace sgs
