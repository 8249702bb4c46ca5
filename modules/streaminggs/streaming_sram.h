// On-chip memory that both orders use.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "modules/auto_choice.h"
#include "modules/streaminggs/fifo_kind.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/streaming_config.h"
#include "tlm/sram_use.h"

namespace sgs {

// FIFOs between VSU and the HFUs.
FifoKind<VisitShare> visit_fifos(const StreamingConfig& config);

// SRAM of the units that both orders have, and of the FIFOs between VSU and the HFUs.
SramUses streaming_sram_uses(const StreamingConfig& config, const BuiltFor& built_for);

// What a design is told of its SRAM beside the configuration.
struct SramPlan {
  std::vector<PixelSize> frames;  // that an open group is to suit
  bool fitted = false;            // MachineDesign::fit_memories()

  std::vector<const char*> fit();
};

// Sizes and checks that depend on each other: a group left to the model (0 px x 0 px) takes what
// the SRAM leaves, in the shape that suits the plan's frames best; SRAM left to the model (0
// bytes), or fitted, is then what is used. uses(): of `config` as it is then. Adds to `chosen`.
// Throws InputError when group and SRAM are left open, and when more is used than there is; the
// message shows the sum.
void resolve_sram(StreamingConfig& config, const StorageConfig& storage, const SramPlan& plan,
                  const std::function<SramUses()>& uses, std::vector<AutoChoice>& chosen);

// Frame sizes that resolve_sram() needs: none where the group is given.
inline std::vector<PixelSize> frames_for(const StreamingConfig& config,
                                         const std::function<std::vector<PixelSize>()>& frames) {
  return config.group_open() ? frames() : std::vector<PixelSize>{};
}

// Throws Error, an InputError with the sum, when more is used of `memory` than there is; key: what
// says how much there is; otherwise: what else than enough it may be, ", or ...", empty: nothing.
template <class Error>
void check_sram(const char* key, std::uint64_t available, const SramUses& uses,
                const std::string& memory, const char* otherwise) {
  const std::uint64_t needed = sram_bytes(uses, memory);
  if (needed <= available) return;
  throw Error(fmt::format("{}: {} bytes are there, expected at least {}{}: {}", key, available,
                          needed, otherwise, largest_uses(uses, memory)));
}

}  // namespace sgs
