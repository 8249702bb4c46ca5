// The rules behind "auto".
#include "modules/auto_config.h"

#include <fmt/format.h>

#include <algorithm>

#include "algorithm/input_error.h"
#include "algorithm/memory/records.h"
#include "modules/dram/address_mapping.h"
#include "modules/dram/memspec.h"

namespace sgs {
namespace {

// A chunk's first halves fill what lies together in one row of one channel: smaller chunks cost
// more tree records than they save, larger ones stream Gaussians that the group does not need.
AutoChoice choose_chunk(const DramConfig& dram) {
  const std::uint32_t run_bytes = AddressMapping(dram, load_memspec(dram.memspec)).run_bytes();
  const std::uint32_t chunk = std::clamp(run_bytes / kFirstHalfBytes, 1U, 64U);
  return {
      "chunk_gaussians", chunk,
      fmt::format("{} first halves of {} B fill the {} B that lie together in a row of a channel",
                  chunk, kFirstHalfBytes, run_bytes)};
}

// Every Gaussian that crosses a border between groups is fetched for both: the larger the group the
// fewer bytes, as long as its pixels fit beside the waiting keys.
AutoChoice choose_group(AcceleratorConfig config) {
  constexpr std::uint32_t kStepPx = 16;
  std::uint32_t largest = 0, bytes = 0;
  for (config.group_px = kStepPx; config.group_px <= 512; config.group_px += kStepPx) {
    const std::uint64_t needed = SramBudget::total(sram_budget(config).shared);
    if (needed > config.sram.shared_bytes) break;
    largest = config.group_px;
    bytes = static_cast<std::uint32_t>(needed);
  }
  if (largest == 0) {
    throw InputError(fmt::format("group_px: not even a group of {} px fits sram.shared_bytes {}",
                                 kStepPx, config.sram.shared_bytes));
  }
  return {"group_px", largest,
          fmt::format("the largest group, in steps of {} px, whose pixels fit: {} of {} B are used",
                      kStepPx, bytes, config.sram.shared_bytes)};
}

}  // namespace

std::vector<AutoChoice> resolve_auto(AcceleratorConfig& config) {
  std::vector<AutoChoice> choices;
  if (config.chunk_gaussians == 0) {
    choices.push_back(choose_chunk(config.dram));
    config.chunk_gaussians = choices.back().value;
  }
  if (config.group_px == 0) {
    choices.push_back(choose_group(config));
    config.group_px = choices.back().value;
  }
  return choices;
}

}  // namespace sgs
