// Keys and on-chip memory of the machine of paper order.
#include "modules/streaminggs/paper_config.h"

#include "algorithm/memory/splat_record.h"
#include "modules/streaminggs/messages.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {

void visit(ConfigVisitor& v, PaperConfig& c) {
  visit_head(v, c);
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("sorting", c.sorting, "each sorting unit");
  visit_tail(v, c);
}

SramUses sram_uses(const PaperConfig& c, const StorageConfig& storage) {
  SramUses uses = streaming_sram_uses(c, widest_format(storage));
  const auto add = [&](const char* name, const SramFactors& factors) {
    uses.push_back(sram_use(name, "shared", factors));
  };
  add("node cache", {{c.vsu.node_cache_bytes, "B"}});
  add("record cache", {{c.vsu.record_cache_bytes, "B"}});
  add("ordering table", {{c.vsu.table_bytes, "B"}});
  // A table of b bytes orders at most b / 8 voxels; each waits as a 4-byte id.
  add("ordered voxels", {{c.vsu.groups_ahead, "groups"}, {c.vsu.table_bytes / 2, "B"}});
  add("candidates",
      {{c.hfus, "HFUs"}, {c.hfu.candidate_fifo_entries, "candidates"}, {kCandidateBytes, "B"}});
  add("splats to sorting", {{c.hfus, "HFUs"},
                            {c.sorting_units, "units"},
                            {c.sorting.input_fifo_entries, "splats"},
                            {kSplatEntryBytes, "B"}});
  add("sort buffers",
      {{c.sorting_units, "units"}, {c.sorting.buffer_entries, "splats"}, {kSplatEntryBytes, "B"}});
  add("splats to rendering", {{c.sorting_units, "units"},
                              {c.rendering.input_fifo_entries, "splats"},
                              {kSplatEntryBytes, "B"}});
  return uses;
}

}  // namespace sgs
