// On-chip memory that both orders use.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "algorithm/memory/second_half.h"
#include "algorithm/memory/storage_config.h"
#include "modules/auto_choice.h"
#include "modules/streaminggs/streaming_config.h"
#include "tlm/sram_use.h"

namespace sgs {

// Second halves that the buffers are built for: of degree 3, with full codebooks.
SecondHalfFormat widest_format(const StorageConfig& storage);

// Input buffer, pixel state, second halves, visits, and decoded Gaussians where they are quantised.
SramUses streaming_sram_uses(const StreamingConfig& config, const SecondHalfFormat& widest);

// Codebooks of one scene in their buffer.
SramUses codebook_sram_uses(const SecondHalfFormat& format);

// Sizes and checks that depend on each other: a group left to the model takes what the SRAM leaves,
// SRAM left to the model (0 bytes) is what is used. uses(): of `config` as it is then. Adds to
// `chosen`. Throws InputError when both are left open, and when more is used than there is; the
// message shows the sum.
void resolve_sram(StreamingConfig& config, const std::function<SramUses()>& uses,
                  std::vector<AutoChoice>& chosen);

// Throws InputError, with the sum, when more is used of `memory` than there is; key: what says how
// much there is.
void check_sram(const char* key, std::uint64_t available, const SramUses& uses,
                const std::string& memory);

}  // namespace sgs
