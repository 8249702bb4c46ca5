// Keys and on-chip memory of the machine of exact order.
#include "modules/streaminggs/exact_config.h"

#include "algorithm/memory/splat_record.h"
#include "modules/streaminggs/streaming_sram.h"

namespace sgs {

void visit(ConfigVisitor& v, ExactConfig& c) {
  visit_head(v, c);
  v.section("vsu", c.vsu, "voxel sorting unit");
  v.section("sorting", c.sorting, "network of each sorting unit");
  v.section("merge", c.merge, "merge unit");
  visit_tail(v, c);
}

SramUses sram_uses(const ExactConfig& c, const StorageConfig& storage) {
  const std::uint32_t runs = c.merge.on_overflow == OnOverflow::kSpill ? c.merge.spill_runs : 0;
  SramUses uses = streaming_sram_uses(c, widest_format(storage));
  const auto add = [&](const char* name, const SramFactors& factors) {
    uses.push_back(sram_use(name, "shared", factors));
  };
  add("node cache", {{c.vsu.node_cache_bytes, "B"}});
  add("walk queue", {{c.vsu.queue_entries, "entries"}, {kWalkEntryBytes, "B"}});
  add("keys to sorting", {{c.hfus, "HFUs"},
                          {c.sorting_units, "units"},
                          {c.hfu.candidate_fifo_entries, "keys"},
                          {kMergeKeyBytes, "B"}});
  add("key sorters",
      {{c.sorting_units, "units"}, {storage.chunk_gaussians, "keys"}, {kMergeKeyBytes, "B"}});
  add("keys to merge",
      {{c.sorting_units, "units"}, {c.merge.input_fifo_entries, "keys"}, {kMergeKeyBytes, "B"}});
  add("waiting keys", {{c.merge.entries, "keys"}, {kWaitingKeyBytes, "B"}});
  add("spilled runs", {{runs, "runs"},
                       {2, "blocks"},
                       {c.merge.spill_block_entries, "keys"},
                       {kSpilledKeyBytes, "B"}});
  add("keys to HFUs",
      {{c.hfus, "HFUs"}, {c.merge.output_fifo_entries, "keys"}, {kMergeKeyBytes, "B"}});
  add("splats to rendering",
      {{c.hfus, "HFUs"}, {c.rendering.input_fifo_entries, "splats"}, {kSplatEntryBytes, "B"}});
  return uses;
}

}  // namespace sgs
