// FIFOs and on-chip memory of the machine of paper order, and what cannot be built.
#include "modules/streaminggs/paper_config.h"

#include <fmt/format.h>

#include "algorithm/files/input_error.h"
#include "modules/streaminggs/sorting/paper_sorter.h"
#include "modules/streaminggs/streaming_sram.h"
#include "modules/streaminggs/vsu/paper_vsu.h"

namespace sgs {

void check(const PaperConfig& c) {
  check_parts(c);
  if (c.lists() % c.sorting_units != 0 || c.sorting_units % c.lists_of_part() != 0) {
    throw InputError(fmt::format(
        "sorting_units: got {} with fetch shared, expected a divisor or a multiple of hfus {}",
        c.sorting_units, c.hfus));
  }
  if (c.sorting.buffer_entries < c.sorting.least_of_runs()) {
    throw InputError(fmt::format(
        "sorting.buffer_entries: got {} splats, expected at least {}: two runs are merged with two "
        "blocks of {} each",
        c.sorting.buffer_entries, c.sorting.least_of_runs(), c.sorting.spill_block_entries));
  }
  if (c.vsu.samples() && !(c.vsu.sample_step_voxels > 0)) {
    throw InputError(fmt::format(
        "vsu.sample_step_voxels: got {} with vsu.samples_per_cycle {}, expected more than 0",
        c.vsu.sample_step_voxels, c.vsu.samples_per_cycle));
  }
  constexpr std::uint32_t kMostNumbered = 8 * 65536;  // bytes: voxels have numbers of 16 bits
  if (c.vsu.samples() && c.vsu.table_bytes > kMostNumbered) {
    throw InputError(
        fmt::format("vsu.table_bytes: got {} with vsu.samples_per_cycle {}, expected at most {}",
                    c.vsu.table_bytes, c.vsu.samples_per_cycle, kMostNumbered));
  }
  if (c.vsu.table_bytes < c.vsu.least_table_bytes()) {
    throw InputError(fmt::format(
        "vsu.table_bytes: got {}, expected at least {}: a word of {} B in "
        "each of vsu.table_banks {}",
        c.vsu.table_bytes, c.vsu.least_table_bytes(), kTableWordBytes, c.vsu.table_banks));
  }
}

void check_rays(const PaperConfig& c) {
  const std::uint32_t longer = std::max(c.group_width_px, c.group_height_px);
  if (c.vsu.ray_step_px <= longer) return;
  throw InputError(
      fmt::format("vsu.ray_step_px: got {}, expected at most {}, a group's longer side",
                  c.vsu.ray_step_px, longer));
}

PaperFifos::PaperFifos(const PaperConfig& c)
    : candidates{"candidates",
                 "candidates",
                 c.fetches(),
                 c.hfu.candidate_fifo_entries,
                 c.hfu.cfu_depth_cycles,
                 "hfu.candidate_fifo_entries"},
      splats{"splats to sorting",        "splats",
             c.fetches() * c.lists(),    c.sorting.input_fifo_entries,
             c.hfu.ffu_depth_cycles,     "sorting.input_fifo_entries",
             splat_entry_bytes(c.splats)},
      sorted{"splats to rendering",          "splats", c.lists(),
             c.rendering.input_fifo_entries, 1,        "rendering.input_fifo_entries",
             splat_entry_bytes(c.splats)} {}

SramUses sram_uses(const PaperConfig& c, const StorageConfig& storage) {
  const BuiltFor made = built_for(c, storage);
  SramUses uses = streaming_sram_uses(c, made);
  add(uses, PaperVsu::sram_uses(c.vsu, made));
  add(uses, PaperSorter::sram_uses(c.sorting, made), c.lists());
  const PaperFifos fifos(c);
  for (const SramUse& use : {fifos.candidates.all(), fifos.splats.all(), fifos.sorted.all()}) {
    add(uses, use);
  }
  return uses;
}

}  // namespace sgs
