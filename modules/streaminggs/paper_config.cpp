// Keys and on-chip memory of the machine of paper order.
#include "modules/streaminggs/paper_config.h"

#include "modules/streaminggs/sorting/paper_sorter.h"
#include "modules/streaminggs/streaming_sram.h"
#include "modules/streaminggs/vsu/paper_vsu.h"

namespace sgs {

void visit(ConfigVisitor& v, PaperConfig& c) {
  visit_head(v, c);
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("sorting", c.sorting, "each sorting unit");
  visit_tail(v, c);
}

PaperFifos::PaperFifos(const PaperConfig& c)
    : candidates{"candidates",
                 "candidates",
                 c.hfus,
                 c.hfu.candidate_fifo_entries,
                 c.hfu.cfu_depth_cycles,
                 "hfu.candidate_fifo_entries"},
      splats{"splats to sorting",      "splats",
             c.hfus * c.sorting_units, c.sorting.input_fifo_entries,
             c.hfu.ffu_depth_cycles,   "sorting.input_fifo_entries"},
      sorted{"splats to rendering",          "splats", c.sorting_units,
             c.rendering.input_fifo_entries, 1,        "rendering.input_fifo_entries"} {}

SramUses sram_uses(const PaperConfig& c, const StorageConfig& storage) {
  const BuiltFor made = built_for(c, storage);
  SramUses uses = streaming_sram_uses(c, made);
  add(uses, PaperVsu::sram_uses(c.vsu));
  add(uses, PaperSorter::sram_uses(c.sorting, made), c.sorting_units);
  const PaperFifos fifos(c);
  for (const SramUse& use : {fifos.candidates.all(), fifos.splats.all(), fifos.sorted.all()}) {
    add(uses, use);
  }
  return uses;
}

}  // namespace sgs
