// FIFOs and on-chip memory of the machine of exact order.
#include "modules/streaminggs/exact_config.h"

#include "modules/streaminggs/merge/merge_unit.h"
#include "modules/streaminggs/sorting/exact_sorter.h"
#include "modules/streaminggs/streaming_sram.h"
#include "modules/streaminggs/vsu/exact_vsu.h"

namespace sgs {

ExactFifos::ExactFifos(const ExactConfig& c)
    : keys{"keys to sorting",
           "keys",
           c.hfus * c.sorting_units,
           c.hfu.candidate_fifo_entries,
           c.hfu.cfu_depth_cycles,
           "hfu.candidate_fifo_entries",
           kKeyBytes},
      sorted_keys{"keys to merge",
                  "keys",
                  c.sorting_units,
                  c.merge.input_fifo_entries,
                  c.merge.latency_cycles,
                  "merge.input_fifo_entries",
                  kKeyBytes},
      released{"keys to HFUs",
               "keys",
               c.hfus,
               c.merge.output_fifo_entries,
               1,
               "merge.output_fifo_entries"},
      splats{"splats to rendering",  "splats",
             c.hfus * c.hfu.eyes,    c.rendering.input_fifo_entries,
             c.hfu.ffu_depth_cycles, "rendering.input_fifo_entries"} {}

SramUses sram_uses(const ExactConfig& c, const StorageConfig& storage) {
  const BuiltFor made = built_for(c, storage);
  SramUses uses = streaming_sram_uses(c, made);
  add(uses, ExactVsu::sram_uses(c.vsu, made));
  add(uses, ExactSorter::sram_uses(made), c.sorting_units);
  add(uses, MergeUnit::sram_uses(c.merge, made));
  const ExactFifos fifos(c);
  for (const SramUse& use :
       {fifos.keys.all(), fifos.sorted_keys.all(), fifos.released.all(), fifos.splats.all()}) {
    add(uses, use);
  }
  return uses;
}

}  // namespace sgs
